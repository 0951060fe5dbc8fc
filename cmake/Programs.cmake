# wedge_command_line(TARGET...): parses options, calls the library and reports. A fresh clone compiles that once and runs
# little of it: optimised less, two thirds of its time.
function(wedge_command_line)
    foreach(target ${ARGN})
        target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    endforeach()
endfunction()

# wedge_command_line_headers(OWNER TARGET...): the libraries that all of its files read, compiled once, with OWNER. The others
# need the same options and definitions.
function(wedge_command_line_headers owner)
    target_precompile_headers(${owner} PRIVATE <algorithm> <cmath> <filesystem> <functional> <map> <memory> <optional> <string>
                                               <vector> <CLI/CLI.hpp> <fmt/format.h> <nlohmann/json.hpp> <host/render/renderer.h>)
    foreach(target ${ARGN})
        target_precompile_headers(${target} REUSE_FROM ${owner})
    endforeach()
endfunction()
