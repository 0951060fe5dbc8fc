# Targets over all sources of ours: `format` lays them out, `tidy` reports likely mistakes. Both need the packages of
# scripts/install_dependencies.sh develop, and nothing else needs them.
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(folders kernels bvh host effects tests benchmarks data/generator)
list(TRANSFORM folders PREPEND ${CMAKE_SOURCE_DIR}/)
add_custom_target(format
    COMMAND find ${folders} "(" -name "*.cpp" -o -name "*.h" -o -name "*.cl" ")" -exec clang-format -i "{}" +
    COMMENT "Laying out the sources" VERBATIM)
# Every file of the build by itself; what the compilation database lists below the source folder.
add_custom_target(tidy
    COMMAND run-clang-tidy -quiet -p ${CMAKE_BINARY_DIR} "^${CMAKE_SOURCE_DIR}/(bvh|host|effects|tests|benchmarks|data)/"
    COMMENT "Looking for likely mistakes" VERBATIM)
