// What is noted of the files that are opened, and that outputs are none of them.
#include "host/error.h"
#include "host/file.h"
#include "host/files_opened.h"
#include "host/image/atomic_file.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <sys/stat.h>
#include <unistd.h>

namespace wedge {
namespace {

namespace fs = std::filesystem;

/// A folder with a file; removed with the object.
class Folder {
public:
    Folder()
    {
        std::string name = (fs::temp_directory_path() / "wedge-opened-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path_ = name;
        std::ofstream(in("a")) << "mine";
    }
    ~Folder() { fs::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string in(const std::string& name) const { return (path_ / name).string(); }
    std::string read(const std::string& name) const { return readFile(in(name), "test file", 100); }

private:
    fs::path path_;
};

bool isWritten(const std::string& path)
{
    try {
        image::AtomicFile file(path);
        file.write("ours");
        file.commit();
        return true;
    } catch (const UsageError&) {
        return false;
    }
}

TEST_CASE("what was opened is written under no name while its notes live")
{
    const Folder folder;
    {
        const FilesOpened inputs;
        CHECK_FALSE(wasOpened(folder.in("a")));
        CHECK(folder.read("a") == "mine");
        fs::create_hard_link(folder.in("a"), folder.in("hard"));
        fs::create_symlink("a", folder.in("link"));
        for (const char* name : { "a", "hard", "link" }) {
            CHECK(wasOpened(folder.in(name)));
            CHECK_FALSE(isWritten(folder.in(name)));
            CHECK_THROWS_AS(image::checkWritable(folder.in(name)), UsageError);
        }
        CHECK_FALSE(wasOpened(""));
        CHECK_FALSE(wasOpened(folder.in("new")));
        CHECK(isWritten(folder.in("new")));
        CHECK(isWritten(folder.in("new")));
        CHECK_NOTHROW(requireNotOpened({ "", folder.in("new"), "/dev/null" }, "remedy"));
        CHECK_THROWS_WITH_AS(requireNotOpened({ folder.in("new"), folder.in("hard") }, "remedy"),
            ("output is a file that is read, test file " + folder.in("a") + ": " + folder.in("hard") + ": remedy")
                .c_str(),
            UsageError);
    }
    CHECK(isWritten(folder.in("a")));
}

TEST_CASE("a file that took the place of one that was opened counts, one of its number does not")
{
    const Folder folder;
    const FilesOpened inputs;
    folder.read("a");
    std::ofstream(folder.in("b")) << "its next version";
    fs::create_hard_link(folder.in("a"), folder.in("old"));
    fs::rename(folder.in("b"), folder.in("a"));
    CHECK(wasOpened(folder.in("a")));
    CHECK_FALSE(wasOpened(folder.in("old")));
    fs::remove(folder.in("a"));
    CHECK(isWritten(folder.in("a")));
}

TEST_CASE("files of all threads are noted, and those that are looked at are not")
{
    const Folder folder;
    const FilesOpened inputs;
    {
        const FilesLookedAt looking;
        folder.read("a");
        CHECK_FALSE(wasOpened(folder.in("a")));
    }
    const FilesOpened inner;
    std::thread([&] { folder.read("a"); }).join();
    CHECK(wasOpened(folder.in("a")));
    CHECK(inputs.paths() == std::vector<fs::path> { folder.in("a") });
    CHECK(inner.paths() == inputs.paths());
}

TEST_CASE("what cannot be opened is told with what the system says")
{
    const Folder folder;
    const FilesOpened inputs;
    const auto said = [&](const std::string& name) {
        try {
            folder.read(name);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto has = [](const std::string& text, const std::string& part) { return text.find(part) != text.npos; };
    CHECK(has(said("gone"), "test file not found: "));
    CHECK(has(said("a/gone"), "test file not found (a part of its path is no folder): "));
    fs::create_symlink("nowhere", folder.in("dangling"));
    CHECK(has(said("dangling"), "test file not found (it is a link to what is not there): "));
    fs::create_symlink("circle", folder.in("circle"));
    CHECK(has(said("circle"), "Too many levels of symbolic links"));
    CHECK(has(said("circle"), "check the links"));
    CHECK(has(said(std::string(300, 'n')), "File name too long"));
    REQUIRE(mkfifo(folder.in("fifo").c_str(), 0600) == 0);
    CHECK(has(said("fifo"), "is not a regular file"));
    CHECK(has(said("."), "is a folder"));
    CHECK(inputs.paths().empty());
    if (::geteuid() != 0) {
        fs::permissions(folder.in("a"), fs::perms::owner_write);
        CHECK(has(said("a"), "Permission denied"));
        CHECK(inputs.paths().empty());
        CHECK(wasOpened(folder.in("a")));
    }
}

} // namespace
} // namespace wedge
