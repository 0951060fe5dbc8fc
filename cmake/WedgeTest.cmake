# wedge_test(NAME LIBRARIES...): builds tests/NAME.cpp (doctest) against LIBRARIES and registers it with CTest.
function(wedge_test name)
    add_executable(${name} ${name}.cpp)
    target_link_libraries(${name} PRIVATE wedge_test_main ${ARGN} wedge_options)
    # A fresh clone compiles each of them once and runs it once: a third less to compile, and as fast where devices work.
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    add_test(NAME ${name} COMMAND ${name})
    # OpenCL drivers cache compiled kernels per process; a shared core count keeps CTest from oversubscribing.
    set_tests_properties(${name} PROPERTIES TIMEOUT 600 ENVIRONMENT "WEDGE_TEST_DATA=${CMAKE_SOURCE_DIR}/data;WEDGE_BUILD_DIR=${CMAKE_BINARY_DIR}")
endfunction()

# wedge_precompile(OWNER HEADER...): what many tests read first is compiled once, with OWNER; others take it by
# target_precompile_headers(TEST REUSE_FROM OWNER), which halves what each takes. They need the same definitions.
function(wedge_precompile owner)
    target_precompile_headers(${owner} PRIVATE <doctest/doctest.h> <algorithm> <array> <cmath> <cstring> <filesystem> <functional>
                                               <limits> <map> <memory> <random> <set> <string> <vector> ${ARGN})
endfunction()

# wedge_skipped_test(NAME REASON): a test that cannot be built here says so in CTest's list in place of being absent.
function(wedge_skipped_test name reason)
    add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${reason}")
    set_tests_properties(${name} PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped: ")
endfunction()
