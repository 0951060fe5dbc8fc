// Runs the program as its users do: a process of its own, its output read back.
#pragma once

#include "host/image/exr.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace wedge::app::test {

inline const std::string program = WEDGE_PROGRAM;
inline const std::string scenes = WEDGE_SOURCE_DATA "/scenes";

inline std::string readAll(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(file), {} };
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// How a run of the program ended and what it said.
struct Outcome {
    int status = -1; ///< exit status, or 1000 + signal
    std::string out, err;
};

/// An empty folder in which the program is run; removed with the object.
class Workplace {
public:
    Workplace()
    {
        std::string name = (std::filesystem::temp_directory_path() / "wedge-app-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        root_ = name;
        std::filesystem::create_directory(path());
        std::filesystem::create_directory(temporary());
        // Kernels compiled by one run serve the next ones.
        ::setenv("WEDGE_CACHE_DIR", WEDGE_TEST_CACHE, 1);
    }
    ~Workplace()
    {
        std::error_code ignored;
        std::filesystem::permissions(path(), std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(root_, ignored);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    std::filesystem::path path() const { return root_ / "work"; }
    std::filesystem::path temporary() const { return root_ / "tmp"; } ///< the program's folder for temporary files

    bool ignoreHangups = false; ///< whether the program is started so

    void write(const std::string& name, const std::string& text) const
    {
        std::ofstream(path() / name, std::ios::binary) << text;
    }
    bool has(const std::string& name) const { return std::filesystem::exists(path() / name); }
    image::LayeredImage exr(const std::string& name) const { return image::readExr((path() / name).string()); }
    std::string text(const std::string& name) const { return readAll(path() / name); }

    /// Names of all files here, sorted.
    std::vector<std::string> files() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path())) {
            names.push_back(entry.path().filename().string());
        }
        std::ranges::sort(names);
        return names;
    }

    /// Runs `wedge ARGUMENTS` in the folder. meanwhile: called with the process id while it runs.
    Outcome run(const std::vector<std::string>& arguments, const std::function<void(pid_t)>& meanwhile = {}) const
    {
        const pid_t child = start(arguments);
        if (meanwhile) {
            meanwhile(child);
        }
        int status = 0;
        while (waitpid(child, &status, 0) < 0 && errno == EINTR) { }
        return { WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), readAll(root_ / "out"),
            readAll(root_ / "err") };
    }

    /// What the program has said on its standard output so far.
    std::string said() const { return readAll(root_ / "out"); }

private:
    pid_t start(const std::vector<std::string>& arguments) const
    {
        std::vector<char*> argv = { const_cast<char*>(program.c_str()) };
        for (const std::string& argument : arguments) {
            argv.push_back(const_cast<char*>(argument.c_str()));
        }
        argv.push_back(nullptr);
        const std::string out = root_ / "out", err = root_ / "err", folder = path();
        const pid_t child = fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            // Shells start background jobs with SIGINT ignored, and nohup others with SIGHUP; the program must see
            // them.
            signal(SIGINT, SIG_DFL);
            signal(SIGHUP, ignoreHangups ? SIG_IGN : SIG_DFL);
            setenv("TMPDIR", temporary().c_str(), 1);
            dup2(open("/dev/null", O_RDONLY), 0);
            dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
            dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
            if (chdir(folder.c_str()) == 0) {
                execv(program.c_str(), argv.data());
            }
            _exit(127);
        }
        return child;
    }

    std::filesystem::path root_;
};

/// Waits until the program says, with --verbose, that its kernels are ready and it renders.
inline void waitUntilRendering(const Workplace& place, pid_t process)
{
    siginfo_t ended {};
    // Bounded, so that a program that never says so fails the test instead of running for ever.
    for (int i = 0; i < 9000 && !contains(place.said(), "kernels ready") && ended.si_pid == 0; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOHANG | WNOWAIT);
    }
}

/// The values of a channel that has to be there.
inline const std::vector<float>& values(const image::LayeredImage& image, std::string_view channel)
{
    const image::Channel* found = image.find(channel);
    INFO("channel ", std::string(channel));
    REQUIRE(found != nullptr);
    return found->values;
}

inline const std::string materials = scenes + "/materials.toml"; // two area lights, a point light, a directional one
inline const std::string box = scenes + "/cornell.toml"; // one area light, nothing specular

using Arguments = std::vector<std::string>;

/// `wedge render` of a small image to a.exr with further arguments; fails the test unless it succeeds in silence.
inline image::LayeredImage render(const Workplace& place, const std::string& scene, Arguments more = {})
{
    Arguments arguments = { "render", scene, "--quiet", "-o", "a.exr" };
    if (std::ranges::find(more, "--size") == more.end()) {
        arguments.insert(arguments.end(), { "--size", "64x48" });
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(outcome.out == "");
    CHECK(outcome.err == "");
    return place.exr("a.exr");
}

/// A metadata entry that has to be there.
inline std::string textOf(const image::LayeredImage& image, const std::string& name)
{
    INFO("metadata ", name);
    REQUIRE(image.metadata.count(name) == 1);
    return std::get<std::string>(image.metadata.at(name));
}

/// Exit statuses.
constexpr int failure = 1, wrongCall = 2;

/// Runs the program and checks how it refuses; what the folder holds stays as it was.
inline void checkRefused(const Workplace& place, const Arguments& arguments, int status, const std::string& value)
{
    std::string call = "wedge";
    for (const std::string& argument : arguments) {
        call += " " + argument;
    }
    CAPTURE(call);
    const std::vector<std::string> before = place.files();
    const Outcome outcome = place.run(arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.status == status);
    CHECK(outcome.err.rfind("wedge: error: ", 0) == 0);
    CHECK(std::ranges::count(outcome.err, '\n') == 1);
    CHECK(outcome.err.back() == '\n');
    CHECK(contains(outcome.err, value));
    CHECK(contains(outcome.err, "--help") == (status == wrongCall));
    CHECK(place.files() == before);
}

/// `wedge render SCENE ARGUMENTS`, small.
inline void checkRenderRefused(
    const Workplace& place, const std::string& scene, Arguments more, int status, const std::string& value)
{
    Arguments arguments = { "render", scene, "-o", "a.exr" };
    arguments.insert(arguments.end(), more.begin(), more.end());
    checkRefused(place, arguments, status, value);
}

/// Parts of a scene file: a camera that looks down on a square, the square, an area light above.
inline const std::string camera = "[camera]\neye = [0, 1, 3]\nlook_at = [0, 0, 0]\n";
inline const std::string quad = "[[mesh]]\nfile = \"" + scenes + "/meshes/quad.obj\"\n";
inline const std::string light =
    "[[light]]\ntype = \"quad\"\ncentre = [0, 3, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\nradiance = 1\n";

} // namespace wedge::app::test
