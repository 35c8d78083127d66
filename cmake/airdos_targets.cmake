# The compiler settings of our own code, in one place.
add_library(airdos_options INTERFACE)
target_compile_options(airdos_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
target_include_directories(airdos_options INTERFACE ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/generated)
if(AIRDOS_SANITIZE)
  target_compile_options(airdos_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                                                  -fno-omit-frame-pointer)
  # An empty optional that is read, an index past the end of a vector: end there, with the line.
  target_compile_definitions(airdos_options INTERFACE _GLIBCXX_ASSERTIONS)
  # GCC 12 sees uninitialized members in its own <regex> once it instruments it.
  target_compile_options(airdos_options INTERFACE -Wno-maybe-uninitialized)
  target_link_options(airdos_options INTERFACE -fsanitize=address,undefined)
endif()

if(AIRDOS_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "AIRDOS_BUILD_FUZZERS needs clang, which brings libFuzzer: install clang and configure with "
                        "-DCMAKE_CXX_COMPILER=clang++ in a build folder of its own, or run launch_scripts/fuzz.sh")
  endif()
  set(airdos_fuzzer_flags -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
      -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/sanitizer_ignorelist.txt)
  # g++ is the judge of warnings; clang knows others.
  target_compile_options(airdos_options INTERFACE ${airdos_fuzzer_flags} -fsanitize=fuzzer-no-link -Wno-everything)
  target_link_options(airdos_options INTERFACE ${airdos_fuzzer_flags})
endif()

# The headers of others that most units read, compiled once for our code and once for the tests (which define other macros).
function(airdos_precompile name)
  if(AIRDOS_PRECOMPILED_HEADERS)
    file(WRITE ${CMAKE_BINARY_DIR}/generated/${name}.cc "// Carries the precompiled headers.\n")
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/generated/${name}.cc)
    target_link_libraries(${name} PRIVATE airdos_options Eigen3::Eigen opencv_core)
    target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map>
                              <memory> <optional> <set> <sstream> <string> <utility> <vector>
                              <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <opencv2/core.hpp> ${ARGN})
  endif()
endfunction()
airdos_precompile(airdos_pch)

# airdos_use_precompiled(TARGET PCH)
function(airdos_use_precompiled name pch)
  if(TARGET ${pch})
    target_precompile_headers(${name} REUSE_FROM ${pch})
  endif()
endfunction()

# airdos_library(NAME SOURCES a.cc b.cc DEPS other libraries)
function(airdos_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC ${ARG_DEPS} PRIVATE airdos_options)
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/generated)
  airdos_use_precompiled(${name} airdos_pch)
endfunction()

# Everything that runs, without the tests.
add_custom_target(airdos_programs)
# airdos_program(NAME SOURCES main.cc DEPS libraries): an installed executable
function(airdos_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} airdos_options)
  add_dependencies(airdos_programs ${name})
  airdos_use_precompiled(${name} airdos_pch)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
endfunction()

# What is tested is optimized as it runs; optimizing the tests would only take time. At -O1 GCC 12 takes an empty optional's
# payload for something uninitialized.
set(airdos_test_options -O1 -Wno-maybe-uninitialized)
# Ends what hangs; a test is not to fail because its machine is busy.
set(AIRDOS_TEST_TIMEOUT_S 1200)
# airdos_test(NAME TIER SOURCES x_test.cc DEPS libraries): a GoogleTest executable; the tier is its ctest label. COST: about the seconds of
# its longest test, for ctest to start long ones first
function(airdos_test name tier)
  cmake_parse_arguments(ARG "" "COST" "SOURCES;DEPS" ${ARGN})
  if(NOT ARG_COST)
    set(ARG_COST 1)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} airdos_options GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE AIRDOS_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                             AIRDOS_BINARY_DIR="${CMAKE_BINARY_DIR}"
                                             _GLIBCXX_ASSERTIONS)
  target_compile_options(${name} PRIVATE ${airdos_test_options})
  airdos_use_precompiled(${name} airdos_test_pch)
  if(NOT TARGET airdos_tests_${tier})  # all tests of one tier
    add_custom_target(airdos_tests_${tier})
  endif()
  add_dependencies(airdos_tests_${tier} ${name})
  set(properties LABELS ${tier} TIMEOUT ${AIRDOS_TEST_TIMEOUT_S} COST ${ARG_COST})
  if(AIRDOS_SANITIZE OR AIRDOS_BUILD_FUZZERS)
    # All tests of a program in one process: to start a sanitized one for each took half of the time.
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES ${properties})
  else()
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES ${properties})
  endif()
endfunction()
