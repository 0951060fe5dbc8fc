// A hostile file or call, what the program has to do with it, and how it is run.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wedge::hostile {

using Folder = std::filesystem::path;
using Arguments = std::vector<std::string>;

enum class Ending {
    Done, ///< status 0 and no error
    Failure, ///< status 1
    WrongCall, ///< status 2
    DoneOrFailure, ///< either, where both are right
};

/// How the process is started, besides its arguments.
struct Start {
    std::optional<std::string> in = "/dev/null"; ///< standard streams: paths, or closed
    std::optional<std::string> out = "", err = ""; ///< "": what the test reads back
    long fileSizeLimit = -1; ///< bytes
    bool ordinaryUser = false; ///< where the test is the superuser's, who may read and write everything
    bool limited = true; ///< its memory, that is
    bool device = false; ///< it gets as far as a driver, whose compiler maps more than it uses
};

struct Row {
    std::string name;
    Arguments call;
    std::function<void(const Folder&)> prepare {}; ///< makes the files in the folder that the program runs in
    Ending ending = Ending::Failure;
    std::string says {}; ///< part of what goes to stderr
    int errors = 1; ///< lines, where it ends in failure
    Start start {};
    std::vector<std::string> makes {}; ///< images and other files that have to be there in the end, beside its folder
                                       ///< as "../tmp/a.exr"
};

using Rows = std::vector<Row>;

// The list, by subject.
Rows callRows();
Rows outputRows();
Rows fileKindRows();
Rows imageRows();
Rows sceneRows();
Rows meshRows();

/// Runs the program and checks that it ends as the row says, with printable lines of bounded length, in bounded memory,
/// and without hanging.
void run(const Row& row);

/// The text in a file of that name.
void write(const Folder& folder, const std::string& name, const std::string& text);

inline std::function<void(const Folder&)> file(const std::string& name, const std::string& text)
{
    return [=](const Folder& folder) { write(folder, name, text); };
}

inline std::string repeated(const std::string& text, std::size_t times)
{
    std::string all;
    all.reserve(text.size() * times);
    for (std::size_t i = 0; i < times; ++i) {
        all += text;
    }
    return all;
}

/// A triangle, with texture coordinates.
inline const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

/// A scene that renders, and a render of it as small as can be: "render", the scene, then the options.
inline const std::string scene = WEDGE_SOURCE_DATA "/scenes/cornell.toml";
inline Arguments tiny(const Arguments& more)
{
    Arguments call = { "render", scene, "--size", "16x16", "--method", "mc", "--spp", "1" };
    call.insert(call.end(), more.begin(), more.end());
    return call;
}

} // namespace wedge::hostile
