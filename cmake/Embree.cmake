# The peer of the benchmarks rays and bvh_build: Embree 3.13 (Debian 12) or 4 (Debian 13), as target wedge_embree with
# WEDGE_EMBREE_MAJOR. Without it these two, and their tests, are left out.
foreach(version 3.13 4)
    if(NOT embree_FOUND)
        find_package(embree ${version} QUIET)
    endif()
endforeach()
if(embree_FOUND)
    add_library(wedge_embree INTERFACE)
    target_link_libraries(wedge_embree INTERFACE embree)
    target_compile_definitions(wedge_embree INTERFACE WEDGE_EMBREE_MAJOR=${embree_VERSION_MAJOR})
else()
    message(STATUS "Embree 3.13 or 4 not found: without the benchmarks rays and bvh_build, which measure against it")
endif()
