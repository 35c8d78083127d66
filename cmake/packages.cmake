# Debian packages of the components (launch_scripts/package.sh makes them), and what is installed for them alone: commands for the
# scripts, completion, the sample log.
set(packages_share ${CMAKE_INSTALL_DATADIR}/airdos)
install(PROGRAMS launch_scripts/keep_map.sh DESTINATION ${packages_share}/scripts COMPONENT runtime)
install(FILES logs/road_crossing06.lcm logs/README.md DESTINATION ${packages_share}/logs COMPONENT runtime)

# The scripts are commands by links: bin/airdos-run-live is share/airdos/scripts/run_live.sh.
set(packages_links ${CMAKE_BINARY_DIR}/packaging)
file(MAKE_DIRECTORY ${packages_links}/bin ${packages_links}/completions)
file(RELATIVE_PATH packages_scripts /${CMAKE_INSTALL_BINDIR} /${packages_share}/scripts)
set(packages_commands)
foreach(script run_live replay_log spy network_setup keep_map)
  string(REPLACE _ - command airdos-${script})
  file(CREATE_LINK ${packages_scripts}/${script}.sh ${packages_links}/bin/${command} SYMBOLIC)
  install(FILES ${packages_links}/bin/${command} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  list(APPEND packages_commands ${command})
endforeach()

# One completion for all; bash looks for it under the name of the command.
get_target_property(packages_programs airdos_programs MANUALLY_ADDED_DEPENDENCIES)
foreach(program IN LISTS packages_programs)
  get_target_property(type ${program} TYPE)
  if(type STREQUAL "EXECUTABLE")
    list(APPEND packages_commands ${program})
  endif()
endforeach()
set(packages_completions ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES packaging/airdos.bash-completion DESTINATION ${packages_completions} RENAME airdos COMPONENT runtime)
foreach(command IN LISTS packages_commands)
  file(CREATE_LINK airdos ${packages_links}/completions/${command} SYMBOLIC)
  install(FILES ${packages_links}/completions/${command} DESTINATION ${packages_completions} COMPONENT runtime)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME airdos)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # the components have their own, which it would be put before
set(CPACK_PACKAGE_VENDOR "The AirDOS on LCM authors")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL runtime dev doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/finish_packages.cmake)
set(CPACK_AIRDOS_SOURCE_DIR ${PROJECT_SOURCE_DIR})

set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The AirDOS on LCM authors <airdos@airdos.invalid>")  # package.sh puts in who builds it
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(packages_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

set(packages_debian ${PROJECT_SOURCE_DIR}/packaging/debian)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME airdos)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "stereo SLAM that uses the people in view, as LCM processes
From rectified stereo images, 2-D keypoints of people and instance masks it
computes the trajectory of the camera, those of the people with their
skeletons, and a static map. The processes exchange LCM messages; a replay
of a log repeats bit for bit. With services for systemd, and a sample log.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS iproute2)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "liblcm-bin, procps")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "airdos-dev, airdos-doc, default-jre, liblcm-java, libjchart2d-java")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${packages_debian}/runtime/postinst ${packages_debian}/runtime/prerm ${packages_debian}/runtime/postrm)

set(CPACK_DEBIAN_DEV_PACKAGE_NAME airdos-dev)
set(CPACK_COMPONENT_DEV_DESCRIPTION "message types of AirDOS for clients
What one needs to write a client of the AirDOS processes: the message types
as .lcm files, C++ headers (find_package, pkg-config), Java classes, and a
Python package that needs nothing but Python.")
set(CPACK_DEBIAN_DEV_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "airdos (= ${packages_version}), liblcm-dev, python3")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "airdos-doc, cmake, pkgconf, default-jdk-headless, liblcm-java")
set(CPACK_DEBIAN_DEV_PACKAGE_CONTROL_EXTRA ${packages_debian}/dev/postinst ${packages_debian}/dev/prerm)

set(CPACK_DEBIAN_DOC_PACKAGE_NAME airdos-doc)
set(CPACK_COMPONENT_DOC_DESCRIPTION "documentation and examples of AirDOS
The pages on architecture, inputs, clients, faults and results, and examples
of clients and camera drivers in C++, Python and Java.")
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
include(CPack)
