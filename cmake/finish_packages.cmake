# What packages have and an installation does not: run by cpack between the two, on the files of all components.
execute_process(
  COMMAND ${CPACK_AIRDOS_SOURCE_DIR}/packaging/finish.sh ${CPACK_AIRDOS_SOURCE_DIR} ${CPACK_TEMPORARY_DIRECTORY}
          ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE} ${CPACK_DEBIAN_PACKAGE_MAINTAINER}
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "packaging/finish.sh failed")
endif()
