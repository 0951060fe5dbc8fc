// A driver's own cache is emptied when a process died at work in it, and only then.
#include "host/device/driver_cache.h"
#include "tests/device_testing.h"

#include <doctest/doctest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

using wedge::device::DriverCache;
namespace fs = std::filesystem;

namespace {

/// A folder of caches in which the driver left a file.
class CacheFolder {
public:
    CacheFolder()
    {
        fs::create_directories(root_ / "driver" / "program");
        std::ofstream(file()) << "truncated";
    }
    ~CacheFolder() { fs::remove_all(root_); }
    CacheFolder(const CacheFolder&) = delete;
    CacheFolder& operator=(const CacheFolder&) = delete;

    const fs::path& root() const { return root_; }
    fs::path file() const { return root_ / "driver" / "program" / "kernel.so"; }
    std::size_t marks() const
    {
        std::size_t count = 0;
        for (const auto& entry : fs::directory_iterator(root_)) {
            count += entry.path().extension() == ".mark" ? 1 : 0;
        }
        return count;
    }
    /// What a start says that finds this folder.
    std::string start(const std::string& users = "") const
    {
        DriverCache cache(root_);
        cache.recover(users);
        return cache.notice();
    }

private:
    fs::path root_ = fs::temp_directory_path() / ("wedge-driver-cache-" + std::to_string(::getpid()));
};

/// Another process that sets its mark and then waits for its end.
class Other {
public:
    explicit Other(const fs::path& root)
    {
        int ready[2] = {};
        REQUIRE(::pipe(ready) == 0);
        process_ = ::fork();
        if (process_ == 0) {
            for (const int signal : { SIGINT, SIGTERM, SIGHUP }) {
                ::signal(signal, SIG_DFL); // the test's own are not the program's
            }
            DriverCache cache(root);
            const DriverCache::Mark mark(cache);
            (void)!::write(ready[1], "x", 1);
            for (;;) {
                ::pause();
            }
        }
        char ignored = 0;
        REQUIRE(::read(ready[0], &ignored, 1) == 1);
        ::close(ready[0]);
        ::close(ready[1]);
    }
    ~Other() { die(); }
    Other(const Other&) = delete;
    Other& operator=(const Other&) = delete;

    void die(int signal = SIGKILL)
    {
        if (process_ > 0) {
            ::kill(process_, signal);
            ::waitpid(process_, nullptr, 0);
            process_ = 0;
        }
    }

private:
    pid_t process_ = 0;
};

} // namespace

TEST_CASE("a cache in which no process died stays")
{
    const CacheFolder folder;
    CHECK(folder.start() == "");
    {
        DriverCache cache(folder.root());
        const DriverCache::Mark outer(cache);
        const DriverCache::Mark inner(cache);
        CHECK(folder.marks() == 1);
    }
    CHECK(folder.marks() == 0);
    CHECK(folder.start() == "");
    CHECK(fs::exists(folder.file()));
}

TEST_CASE("a cache in which a process died is emptied, and the next start is told where it is")
{
    const CacheFolder folder;
    Other other(folder.root());
    CHECK(folder.marks() == 1);
    other.die();
    CHECK(folder.marks() == 1);
    const std::string notice = folder.start();
    CHECK(notice.find((folder.root() / "driver").string()) != std::string::npos);
    CHECK(notice.find("emptied") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.file()));
    CHECK(fs::exists(folder.root() / "driver"));
    CHECK(folder.marks() == 0);
    CHECK(folder.start() == ""); // once
}

TEST_CASE("a cache that another process works in is left alone until that ends")
{
    const CacheFolder folder;
    Other dead(folder.root());
    Other alive(folder.root());
    dead.die();
    CHECK(folder.start() == "");
    CHECK(fs::exists(folder.file()));
    alive.die();
    CHECK(folder.start() != "");
    CHECK_FALSE(fs::exists(folder.file()));
}

TEST_CASE("a process that the user ended takes its mark along")
{
    const CacheFolder folder;
    for (const int signal : { SIGINT, SIGTERM, SIGHUP }) {
        Other other(folder.root());
        CHECK(folder.marks() == 1);
        other.die(signal);
        CHECK(folder.marks() == 0);
    }
    CHECK(folder.start() == "");
    CHECK(fs::exists(folder.file()));
}

TEST_CASE("a folder that the user chose is named and left alone")
{
    const CacheFolder folder;
    Other(folder.root()).die();
    const std::string notice = folder.start("/home/them/cache");
    CHECK(notice.find("POCL_CACHE_DIR=/home/them/cache") != std::string::npos);
    CHECK(notice.find("emptied") == std::string::npos);
    CHECK(fs::exists(folder.file()));
    CHECK(folder.marks() == 0);
}

TEST_CASE("without a folder, or where it cannot be written, there are no marks and no errors")
{
    DriverCache none { fs::path() };
    none.recover("");
    CHECK(none.notice() == "");
    CHECK(none.folder() == fs::path());
    const DriverCache::Mark mark(none);
    DriverCache unwritable { fs::path("/proc/no/such/folder") };
    unwritable.recover("");
    const DriverCache::Mark other(unwritable);
    CHECK(unwritable.notice() == "");
}
