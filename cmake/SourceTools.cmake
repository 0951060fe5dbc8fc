# Targets over all sources of ours: `format` lays them out, `tidy` reports likely mistakes. Both need the packages of
# scripts/install_dependencies.sh develop, and nothing else needs them.
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_custom_target(format
    COMMAND bash ${CMAKE_SOURCE_DIR}/scripts/format.sh
    COMMENT "Laying out the sources" VERBATIM)
add_custom_target(tidy
    COMMAND bash ${CMAKE_SOURCE_DIR}/scripts/tidy.sh --all --build ${CMAKE_BINARY_DIR}
    COMMENT "Looking for likely mistakes" VERBATIM)
