// Where caches lie when the folder that is wanted cannot be had, and that no other user can have made that place.
#include "host/device/cache_folder.h"
#include "host/device/cache_root.h"
#include "tests/device_testing.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

using namespace wedge::device;
using wedge::test::contains;
using wedge::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

mode_t modeOf(const fs::path& path)
{
    struct stat found { };
    REQUIRE(::lstat(path.c_str(), &found) == 0);
    return found.st_mode & 07777;
}

std::string own(int number = 1)
{
    const std::string name = "wedge-" + std::to_string(::geteuid());
    return number == 1 ? name : name + "-" + std::to_string(number);
}

/// A folder for temporary files as systems have them: everybody's, in which each user renames only what is his.
struct Shared {
    Shared() { REQUIRE(::chmod(folder.path().c_str(), 01777) == 0); }
    TemporaryFolder folder;
    const fs::path path = folder.path();
};

/// Where nobody can make anything, the superuser neither.
const fs::path impossible = "/dev/null/caches";

} // namespace

TEST_CASE("the wanted folder is made and used; one that cannot be is replaced, with a line that says why")
{
    const Shared shared;
    const CacheRoot good = CacheRoot::find({ shared.path / "a" / "b", false }, { shared.path });
    CHECK(good.folder == shared.path / "a" / "b");
    CHECK(good.notice.empty());
    CHECK(!fs::exists(shared.path / own()));

    const CacheRoot other = CacheRoot::find({ impossible, false }, { shared.path });
    CHECK(other.folder == shared.path / own());
    CHECK(contains(other.notice, impossible.string() + " (Not a directory)"));
    CHECK(contains(other.notice, other.folder.string() + " is used; set WEDGE_CACHE_DIR"));
    CHECK(other.failure.empty());
    CHECK(modeOf(other.folder) == 0700);
    // The next process gets the same one.
    CHECK(CacheRoot::find({ {}, false }, { shared.path }).folder == other.folder);
    CHECK(contains(CacheRoot::find({ {}, false }, { shared.path }).notice, "HOME is not set"));
    // A file of the wanted folder's name, and a temporary folder that is not there.
    std::ofstream(shared.path / "file") << "x";
    CHECK(CacheRoot::find({ shared.path / "file", false }, { impossible, shared.path }).folder == other.folder);
}

TEST_CASE("where no folder is to be had all reasons are told, and where none is wanted none is looked for")
{
    const CacheRoot none = CacheRoot::find({ impossible, false }, { impossible, "/dev/null" });
    CHECK(none.folder.empty());
    CHECK(none.notice.empty());
    CHECK(
        contains(none.failure, "/dev/null/caches (Not a directory), /dev/null/caches (Not a directory), /dev/null ("));
    const Shared shared;
    const CacheRoot off = CacheRoot::find({ {}, true }, { shared.path });
    CHECK(off.folder.empty());
    CHECK(off.failure.empty());
    CHECK(fs::is_empty(shared.path));
}

TEST_CASE("a temporary folder that another user may have made is passed over")
{
    const Shared shared;
    const fs::path target = shared.path / "target";
    REQUIRE(::mkdir(target.c_str(), 0700) == 0);
    fs::create_directory_symlink(target, shared.path / own(1)); // a link, also to a folder of ours
    REQUIRE(::mkdir((shared.path / own(2)).c_str(), 0700) == 0);
    REQUIRE(::chmod((shared.path / own(2)).c_str(), 0777) == 0); // others can write
    REQUIRE(::mkdir((shared.path / own(3)).c_str(), 0750) == 0); // or read
    std::ofstream(shared.path / own(4)) << "no folder";
    if (::geteuid() == 0) {
        REQUIRE(::mkdir((shared.path / own(5)).c_str(), 0700) == 0);
        REQUIRE(::chown((shared.path / own(5)).c_str(), 65534, 65534) == 0); // another user's
    }
    const FolderOrReason found = ownTemporaryFolder(shared.path);
    CHECK(found.folder == shared.path / own(::geteuid() == 0 ? 6 : 5));
    CHECK(modeOf(found.folder) == 0700);
    CHECK(fs::is_empty(target));
    for (int i = 2; i <= 8; ++i) {
        std::error_code ignored;
        fs::remove_all(shared.path / own(i), ignored);
        std::ofstream(shared.path / own(i)) << "taken";
    }
    const FolderOrReason unforeseen = ownTemporaryFolder(shared.path);
    CHECK(contains(unforeseen.folder.string(), own() + "-"));
    CHECK(modeOf(unforeseen.folder) == 0700);
}

TEST_CASE("in a folder where others may rename what is in it, none is made")
{
    const Shared shared;
    REQUIRE(::chmod(shared.path.c_str(), 0777) == 0); // without the sticky bit
    CHECK(contains(ownTemporaryFolder(shared.path).reason, "others may rename"));
    REQUIRE(::chmod(shared.path.c_str(), 0700) == 0);
    CHECK(!ownTemporaryFolder(shared.path).folder.empty());
    if (::geteuid() == 0) {
        REQUIRE(::chown(shared.path.c_str(), 65534, 65534) == 0);
        CHECK(contains(ownTemporaryFolder(shared.path).reason, "another user's"));
    }
}
