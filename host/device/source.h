#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace wedge::device {

/// A .cl file with its includes put in place.
struct FlatSource {
    std::string text;
    std::vector<std::string> files; ///< what it was made of, in order of first appearance, as #line names them
};

/// Texts that are made and not kept in a file, by the path that includes name them with.
using GeneratedSources = std::map<std::string, std::string, std::less<>>;

/// Reads `file` (relative to kernels/) and puts each `#include "x.h"` in place, with `#line` directives so that the
/// compiler's messages name the real file and line. An include is looked for in the including file's folder, then in
/// kernels/. Each file comes in once a program, at its first include, whatever conditionals stand around it;
/// `#include <...>` stays as it is. Of includes from pass/, interfaces of kernels, those that are not generated are
/// left out: kernels that a program has no need of ask for them.
///
/// kernelDir: a folder that is looked in before the embedded sources, file by file; "" for the embedded ones alone.
/// generated: looked in before both, for includes.
/// Throws Error for a missing file or folder, and for files that include each other, with the including file and line.
FlatSource flattenKernel(const std::string& kernelDir, const std::string& file, const GeneratedSources& generated = {});

/// Throws Error, with the system's reason, where a folder of kernels is none or cannot be looked at.
void requireKernelFolder(const std::string& folder);

/// A compiler's messages, with the places in which some drivers (NVIDIA's) count the lines of a flattened source and
/// look at no #line, `<kernel>:18:`, named as others name them: `kernels/frame/primary.cl:5:`.
std::string namePlaces(const std::string& log, const std::string& flatSource);

} // namespace wedge::device
