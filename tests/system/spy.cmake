# The plugins for lcm-spy: once without a display, once in the real lcm-spy on a virtual one.
if(NOT TARGET airdos_jar)
  add_test(NAME spy_renderer_test COMMAND ${CMAKE_COMMAND} -E echo
           "SKIPPED: airdos.jar is not built: no JDK (default-jdk-headless) or no lcm.jar (liblcm-java), or AIRDOS_BUILD_JAVA=OFF")
  set_tests_properties(spy_renderer_test PROPERTIES LABELS system SKIP_REGULAR_EXPRESSION SKIPPED)
  return()
endif()

find_program(AIRDOS_JAVA java REQUIRED)
get_target_property(jar airdos_jar AIRDOS_JAR)
set(spy_test_sources ${PROJECT_SOURCE_DIR}/tests/support/SpyTestStream.java
                     ${CMAKE_CURRENT_SOURCE_DIR}/SpyRendererTest.java ${CMAKE_CURRENT_SOURCE_DIR}/SpyWindowTest.java)
set(spy_test_classes ${CMAKE_CURRENT_BINARY_DIR}/spy_test_classes)
set(spy_test_classpath ${jar}:${AIRDOS_LCM_JAR}:/usr/share/java/jchart2d.jar:${spy_test_classes})
add_custom_command(
  OUTPUT ${spy_test_classes}/airdos/spy/SpyRendererTest.class
  COMMAND ${Java_JAVAC_EXECUTABLE} --release 8 -Xlint:all,-options,-serial,-path -Werror -d ${spy_test_classes}
          -cp ${jar}:${AIRDOS_LCM_JAR} ${spy_test_sources}
  DEPENDS airdos_jar ${jar} ${spy_test_sources}
  VERBATIM)
add_custom_target(spy_test_classes ALL DEPENDS ${spy_test_classes}/airdos/spy/SpyRendererTest.class)

add_test(NAME spy_renderer_test COMMAND ${AIRDOS_JAVA} -Djava.awt.headless=true -Xmx256m -ea -cp ${spy_test_classpath}
                                        airdos.spy.SpyRendererTest)
set_tests_properties(spy_renderer_test PROPERTIES LABELS system TIMEOUT ${AIRDOS_TEST_TIMEOUT_S})
add_test(NAME spy_window_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/spy_window_test.sh ${spy_test_classpath}
                                      ${CMAKE_BINARY_DIR}/screenshots)
set_tests_properties(spy_window_test PROPERTIES LABELS system TIMEOUT ${AIRDOS_TEST_TIMEOUT_S} SKIP_RETURN_CODE 77)
