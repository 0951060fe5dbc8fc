// Lists whose length the device knows, and no host: what passes find among pixels or receivers. There is memory for so
// many elements and no more; what has no room is left out, and counted. Elements come in the order of the blocks that
// find them, whatever the order in which those run:
//   1. a pass writes how many elements each block has, a list of graph::counts;
//   2. placeBlocks() finds where each block's begin;
//   3. a pass writes them there, by WEDGE_APPEND of kernels/core/lists.h;
//   4. passes over the elements (Domain::Items) have countedBy() among their arguments in place of a count, and
//      WEDGE_ITEM(i) in their kernels.
#pragma once

#include "host/graph/graph.h"

#include <cstdint>
#include <string>
#include <vector>

namespace wedge::graph {

struct Placed { }; ///< indices of elements, and how many

/// Where the elements of a list go.
struct ListPlaces {
    Handle<Placed> first; ///< of each block: the index of its first element, which may be beyond the list
    Handle<Placed> listed; ///< two numbers: elements of the list, and how many had no room
    std::uint32_t capacity; ///< of the list
};

/// Declares the passes that find places. kernels: the file that includes core/lists.h. elements: of each block, how
/// many.
ListPlaces placeBlocks(
    Graph& graph, const std::string& name, const std::string& kernels, const Version& elements, std::uint32_t capacity);

/// A number that is 0 where nothing is to be computed, whatever memory holds then.
Argument unlessEmpty(std::string name, std::uint32_t number);

/// Two arguments by which a pass is launched over all that a list has room for, and its kernel goes by those that there
/// are: NAME, ListPlaces::listed, and NAME_most.
std::vector<Argument> countedBy(const std::string& name, const ListPlaces& places);

} // namespace wedge::graph
