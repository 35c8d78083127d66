# Writes OUTPUT, a source file with the commit that SOURCE_DIR is at ("unknown" without git, or where git does not know the
# folder, as in an unpacked archive). Run by each build; the file is touched only if the commit is another one.
set(commit unknown)
find_program(GIT git)
if(GIT)
  # A folder of another project's working tree is not at that project's commit unless it is kept there.
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} ls-files --error-unmatch CMakeLists.txt
                  RESULT_VARIABLE unknown OUTPUT_QUIET ERROR_QUIET)
  if(unknown EQUAL 0)
    execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse --short=7 HEAD
                    RESULT_VARIABLE failed OUTPUT_VARIABLE answer OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(failed EQUAL 0)
      set(commit ${answer})
    endif()
  endif()
endif()
set(text "#include \"common/util/commit.h\"\n\nnamespace airdos {\nconst char kCommit[] = \"${commit}\";\n}  // namespace airdos\n")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUTPUT} "${text}")
endif()
