# Checks by other tools than doctest: scripts/install_dependencies.sh test installs them.

add_test(NAME kernel_lint COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/kernel_lint.sh ${CMAKE_SOURCE_DIR}/kernels
                                   $<TARGET_FILE:kernel_programs>)
add_test(NAME docs_code COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/docs_code.sh ${CMAKE_SOURCE_DIR})
add_test(NAME kernels_named COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/kernels_named.sh ${CMAKE_SOURCE_DIR})
# In parts, which run beside each other and beside other tests; the last asks whether all kernels ran in one of them.
foreach(part 1 2 3 4 kernels)
    add_test(NAME oclgrind_frame_${part}
             COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/oclgrind_frame.sh $<TARGET_FILE:wedge> ${CMAKE_SOURCE_DIR}
                     ${CMAKE_BINARY_DIR}/oclgrind_frames ${part} 4)
    list(APPEND oclgrind_frames oclgrind_frame_${part})
endforeach()
set_tests_properties(oclgrind_frame_1 oclgrind_frame_2 oclgrind_frame_3 oclgrind_frame_4 PROPERTIES FIXTURES_SETUP
                                                                                                    oclgrind_frames)
set_tests_properties(oclgrind_frame_kernels PROPERTIES FIXTURES_REQUIRED oclgrind_frames)
add_test(NAME second_driver COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/second_driver.sh $<TARGET_FILE:wedge>
                                    $<TARGET_FILE:bvh_traverse_test> $<TARGET_FILE:bvh_traverse_families_test>
                                    $<TARGET_FILE:bvh_watertight_test> $<TARGET_FILE:device_buffer_test>)
add_test(NAME readers COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/readers.sh ${CMAKE_SOURCE_DIR})
add_test(NAME bare_root COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/bare_root.sh ${CMAKE_SOURCE_DIR}/scripts/bare.sh)
add_test(NAME tidy_changed COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/tidy_changed.sh ${CMAKE_SOURCE_DIR})
add_test(NAME format_check COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/format_check.sh ${CMAKE_SOURCE_DIR})
add_test(NAME installed COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/installed.sh ${CMAKE_COMMAND} ${CMAKE_BINARY_DIR})
add_test(NAME maaf_flatland COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/maaf_flatland.sh ${CMAKE_SOURCE_DIR})
add_test(NAME maaf_lens COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/scripts/maaf_lens.sh ${CMAKE_SOURCE_DIR})
set_tests_properties(bare_root tidy_changed format_check maaf_flatland maaf_lens PROPERTIES SKIP_RETURN_CODE 77)
# Simulated devices are slow, and slower still beside other tests.
set_tests_properties(kernel_lint ${oclgrind_frames} second_driver PROPERTIES TIMEOUT 1200)
set_tests_properties(${oclgrind_frames} PROPERTIES LABELS long) # test.sh
# What the system has no package for cannot be run, and its test says so.
set_tests_properties(${oclgrind_frames} second_driver PROPERTIES SKIP_REGULAR_EXPRESSION "skipped: this system has no ")

# The tests of the shared maths once more, under the sanitizers, whatever the build type: device code cannot be run
# under them. With casts of floats out of range, which on devices give any value at all.
add_executable(shared_maths_sanitized kernel_rng_test.cpp kernel_maths_test.cpp kernel_bsdf_test.cpp
                                      kernel_defocus_test.cpp kernel_camera_test.cpp kernel_packed_test.cpp)
target_compile_options(shared_maths_sanitized PRIVATE -O1 -g -fno-omit-frame-pointer -fno-sanitize-recover=all
                                                      -fsanitize=address,undefined,float-cast-overflow)
target_link_options(shared_maths_sanitized PRIVATE -fsanitize=address,undefined)
target_link_libraries(shared_maths_sanitized PRIVATE wedge_test_main wedge_shared wedge_options)
add_test(NAME shared_maths_sanitized COMMAND shared_maths_sanitized)
set_tests_properties(shared_maths_sanitized PROPERTIES TIMEOUT 600)
