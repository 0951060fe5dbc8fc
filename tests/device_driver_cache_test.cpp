// A driver's own cache is emptied when a process died at work in it, and only then.
#include "host/device/driver_cache.h"
#include "tests/device_testing.h"

#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

using wedge::device::DriverCache;
namespace fs = std::filesystem;

namespace {

void writeText(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

/// A folder of caches in which the driver left a file.
class CacheFolder {
public:
    CacheFolder()
    {
        const DriverCache cache(root_);
        REQUIRE(cache.folder() == driver());
        fs::create_directories(driver() / "program");
        writeText(file(), "compiled");
    }
    ~CacheFolder() { fs::remove_all(root_); }
    CacheFolder(const CacheFolder&) = delete;
    CacheFolder& operator=(const CacheFolder&) = delete;

    const fs::path& root() const { return root_; }
    fs::path driver() const { return root_ / "wedge-pocl"; }
    fs::path file() const { return driver() / "program" / "kernel.so"; }
    /// As a process does that compiles nothing new.
    void use() const
    {
        DriverCache cache(root_);
        const DriverCache::Mark mark(cache);
    }
    std::size_t marks() const
    {
        std::size_t count = 0;
        for (const auto& entry : fs::directory_iterator(driver())) {
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
    CHECK(notice.find(folder.driver().string()) != std::string::npos);
    CHECK(notice.find("emptied") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.file()));
    CHECK(fs::exists(folder.driver()));
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

TEST_CASE("a file that is not what it was when it ran is removed, and no other")
{
    const CacheFolder folder;
    const fs::path other = folder.driver() / "program" / "program.bc", unread = folder.driver() / "program" / "log";
    writeText(other, "other");
    writeText(unread, "read by nobody");
    folder.use();
    CHECK(folder.start() == "");
    writeText(folder.file(), std::string("comp\0led", 8)); // of the same length
    writeText(unread, "changed");
    const std::string notice = folder.start();
    CHECK(notice.find("removed, to be compiled again: 1 in " + folder.driver().string()) != std::string::npos);
    CHECK_FALSE(fs::exists(folder.file()));
    CHECK(fs::exists(other));
    CHECK(fs::exists(unread));
    CHECK(folder.start() == ""); // once
    writeText(folder.file(), "compiled anew");
    folder.use();
    CHECK(folder.start() == "");
    CHECK(fs::exists(folder.file()));
}

TEST_CASE("a file that another process may just have written anew is left to it")
{
    const CacheFolder folder;
    folder.use();
    Other alive(folder.root());
    writeText(folder.file(), "anew");
    fs::last_write_time(folder.file(), fs::file_time_type::clock::now() + std::chrono::seconds(5));
    CHECK(folder.start() == "");
    CHECK(fs::exists(folder.file()));
}

TEST_CASE("without a whole record nothing is trusted")
{
    for (const char* damaged : { "", "wedge record 1\n", "wedge record 1\n12 34\nend\n" }) {
        const CacheFolder folder;
        folder.use();
        writeText(folder.driver() / "record", damaged);
        CHECK(folder.start().find("was emptied") != std::string::npos);
        CHECK_FALSE(fs::exists(folder.file()));
        CHECK(folder.start() == "");
    }
}

TEST_CASE("files of others stay, whatever they are called")
{
    const CacheFolder folder;
    const fs::path theirs = folder.root() / "thesis.txt";
    for (const char* name : { "notes.mark", "12.mark", "driver/thesis.txt" }) {
        fs::create_directories((folder.root() / name).parent_path());
        writeText(folder.root() / name, name[0] == '1' ? "" : "theirs");
    }
    writeText(theirs, "theirs");
    writeText(folder.driver() / "7.mark", "no mark, since it is not empty");
    fs::create_symlink(theirs, folder.driver() / "8.mark");
    fs::create_symlink(folder.root() / "driver", folder.driver() / "link");
    CHECK(folder.start() == "");
    Other(folder.root()).die();
    CHECK(folder.start() != "");
    CHECK_FALSE(fs::exists(folder.file()));
    for (const char* name : { "notes.mark", "12.mark", "driver/thesis.txt", "thesis.txt" }) {
        CHECK(fs::exists(folder.root() / name));
    }
}

TEST_CASE("a folder of our name that is not of our making is not used")
{
    const CacheFolder folder;
    const fs::path root = folder.root() / "other";
    fs::create_directories(root / "wedge-pocl");
    CHECK(DriverCache(root).folder() == root / "wedge-pocl"); // empty: nobody's
    CHECK(DriverCache(root).folder() == root / "wedge-pocl");
    fs::remove_all(root / "wedge-pocl");
    fs::create_directories(root / "wedge-pocl");
    writeText(root / "wedge-pocl" / "thesis.txt", "theirs");
    DriverCache cache(root);
    CHECK(cache.folder().empty());
    {
        const DriverCache::Mark mark(cache);
    }
    cache.recover("");
    CHECK(cache.notice() == "");
    CHECK(std::distance(fs::directory_iterator(root / "wedge-pocl"), fs::directory_iterator()) == 1);
    fs::remove_all(root / "wedge-pocl");
    fs::create_directory_symlink(folder.driver(), root / "wedge-pocl");
    CHECK(DriverCache(root).folder().empty());
    CHECK(fs::exists(folder.file()));
}

TEST_CASE("a folder that this user cannot write, or another one owns, is not used")
{
    const CacheFolder folder;
    if (::geteuid() == 0) { // who may write everywhere
        REQUIRE(::chown(folder.driver().c_str(), 12345, 12345) == 0);
        CHECK(DriverCache(folder.root()).folder().empty());
        REQUIRE(::chown(folder.driver().c_str(), 0, 0) == 0);
    } else {
        fs::permissions(folder.driver(), fs::perms::owner_read | fs::perms::owner_exec);
        CHECK(DriverCache(folder.root()).folder().empty());
        fs::permissions(folder.driver(), fs::perms::owner_all);
    }
    CHECK(DriverCache(folder.root()).folder() == folder.driver());
}

TEST_CASE("a mark that cannot be opened does not keep the cache from being emptied")
{
    const CacheFolder folder;
    Other(folder.root()).die();
    writeText(folder.driver() / "1.mark", "");
    fs::permissions(folder.driver() / "1.mark", fs::perms::none);
    const bool superuser = ::geteuid() == 0; // who may open everything, and so becomes another one
    constexpr uid_t user = 12345;
    if (superuser) {
        for (const auto& entry : fs::recursive_directory_iterator(folder.root())) {
            REQUIRE(::chown(entry.path().c_str(), user, user) == 0);
        }
        REQUIRE(::seteuid(user) == 0);
    }
    const std::string notice = folder.start(), again = folder.start();
    if (superuser) {
        REQUIRE(::seteuid(0) == 0);
    }
    CHECK(notice.find("was emptied") != std::string::npos);
    CHECK(again == "");
    CHECK_FALSE(fs::exists(folder.file()));
}

TEST_CASE("without a folder, or where it cannot be made, there are no marks and no errors")
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
