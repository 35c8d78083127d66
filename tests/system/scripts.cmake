# The launch scripts, and the direction of includes. The scripts' own tests take seconds; a busy machine may need minutes.
add_test(NAME scripts_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts_test.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(scripts_test PROPERTIES LABELS system TIMEOUT 600 SKIP_RETURN_CODE 77)
add_test(NAME scripts_ends_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts_ends_test.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(scripts_ends_test PROPERTIES LABELS system TIMEOUT 600)
add_test(NAME scripts_live_ends_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/scripts_live_ends_test.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(scripts_live_ends_test PROPERTIES LABELS system TIMEOUT 600 SKIP_RETURN_CODE 77)
add_test(NAME long_run_ends_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/long_run_ends_test.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(long_run_ends_test PROPERTIES LABELS system TIMEOUT 600)
add_test(NAME install_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/install_test.sh ${CMAKE_BINARY_DIR}
                                   $<IF:$<TARGET_EXISTS:airdos_jar>,JAR,NO_JAR>)
set_tests_properties(install_test PROPERTIES LABELS system TIMEOUT 180 ENVIRONMENT CXX=${CMAKE_CXX_COMPILER})
add_test(NAME includes_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/includes_test.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(includes_test PROPERTIES LABELS unit TIMEOUT 60)
add_test(NAME benchmarks_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks_test.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(benchmarks_test PROPERTIES LABELS system TIMEOUT 180 SKIP_RETURN_CODE 77)
add_test(NAME long_run_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/long_run_test.sh ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
set_tests_properties(long_run_test PROPERTIES LABELS system TIMEOUT 600 SKIP_RETURN_CODE 77 COST 100)
add_test(NAME mutation_lists_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/mutation_lists_test.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(mutation_lists_test PROPERTIES LABELS system TIMEOUT 180)
# Clients as outside users build them, with our processes. The programs it compiles, and Java, are few but slow on a busy machine.
add_test(NAME clients_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/clients_test.sh ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}
                                   $<IF:$<TARGET_EXISTS:airdos_jar>,JAR,NO_JAR>)
set_tests_properties(clients_test PROPERTIES LABELS system TIMEOUT 600 SKIP_RETURN_CODE 77 ENVIRONMENT CXX=${CMAKE_CXX_COMPILER})
