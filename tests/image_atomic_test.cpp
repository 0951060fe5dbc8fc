#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/png.h"

#include "host/error.h"
#include "tests/image_test_support.h"

#include <array>
#include <csignal>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <functional>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace wedge::image;
using namespace wedge::image::test;

namespace {

std::string messageOf(const std::function<void()>& action)
{
    try {
        action();
    } catch (const wedge::Error& error) {
        return error.what();
    }
    return "no error";
}

// Root may write anywhere, so that permissions can be tested only as somebody else.
class AsOrdinaryUser {
public:
    AsOrdinaryUser() { changed_ = geteuid() == 0 && seteuid(65534) == 0; }
    ~AsOrdinaryUser()
    {
        if (changed_ && seteuid(0) != 0)
            std::abort();
    }

private:
    bool changed_ = false;
};

// Files may grow to that many bytes only, which fails a write halfway as a full disk does.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes)
    {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit { bytes, before_.rlim_max };
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

private:
    rlimit before_ {};
};

} // namespace

TEST_CASE("a file appears at commit, and its temporary file is in the same directory until then")
{
    const TempDirectory directory;
    const std::string path = directory / "report.json";
    {
        AtomicFile file(path);
        file.write("{\"a\"");
        file.write("");
        file.write(": 1}");
        CHECK_FALSE(std::filesystem::exists(path));
        CHECK(std::filesystem::path(file.tempPath()).parent_path() == directory.path());
        CHECK(std::filesystem::exists(file.tempPath()));
        file.commit();
        CHECK(readBytes(path) == "{\"a\": 1}");
    }
    CHECK(readBytes(path) == "{\"a\": 1}");
    CHECK(directory.entries() == 1);
}

TEST_CASE("without a commit nothing changes")
{
    const TempDirectory directory;
    const std::string path = directory / "old.txt";
    writeBytes(path, "old");
    {
        AtomicFile file(path);
        file.write("new, but the program failed");
    }
    CHECK(readBytes(path) == "old");
    CHECK(directory.entries() == 1);
    {
        AtomicFile file(path);
        file.write("new");
        file.commit();
    }
    CHECK(readBytes(path) == "new");
    CHECK(directory.entries() == 1);
}

TEST_CASE("two writers of one path do not meet")
{
    const TempDirectory directory;
    const std::string path = directory / "a";
    AtomicFile first(path);
    AtomicFile second(path);
    CHECK(first.tempPath() != second.tempPath());
    first.write("first");
    second.write("second");
    first.commit();
    second.commit();
    CHECK(readBytes(path) == "second");
    CHECK(directory.entries() == 1);
}

TEST_CASE("new files get the permissions that the process gives files, and links stay links")
{
    const TempDirectory directory;
    const mode_t mask = umask(027);
    AtomicFile file(directory / "a");
    file.commit();
    umask(mask);
    CHECK((std::filesystem::status(directory / "a").permissions() & std::filesystem::perms::mask)
        == static_cast<std::filesystem::perms>(0640));

    std::filesystem::create_symlink(directory / "a", directory / "link");
    AtomicFile throughLink(directory / "link");
    throughLink.write("through");
    throughLink.commit();
    CHECK(std::filesystem::is_symlink(directory / "link"));
    CHECK(readBytes(directory / "a") == "through");
}

TEST_CASE("a link to a file that is not there yet stays a link, and the file appears")
{
    const TempDirectory directory;
    std::filesystem::create_directory(directory / "d");
    std::filesystem::create_symlink("d/b", directory / "link");
    std::filesystem::create_symlink("link", directory / "second");
    CHECK(behindLinks(directory / "second") == directory / "d/b");
    CHECK(behindLinks(directory / "a") == directory / "a");
    checkWritable(directory / "second");
    CHECK(std::filesystem::is_empty(directory / "d"));
    AtomicFile file(directory / "second");
    file.write("through both");
    file.commit();
    CHECK(std::filesystem::is_symlink(directory / "second"));
    CHECK(std::filesystem::is_symlink(directory / "link"));
    CHECK(readBytes(directory / "d/b") == "through both");
    std::filesystem::create_symlink("circle", directory / "circle");
    CHECK(messageOf([&] { checkWritable(directory / "circle"); }).find("symbolic links") != std::string::npos);
}

TEST_CASE("a pipe is written to who reads it, and nobody is waited for")
{
    const TempDirectory directory;
    const std::string path = directory / "pipe";
    REQUIRE(mkfifo(path.c_str(), 0600) == 0);
    checkWritable(path); // somebody may read it by then
    CHECK(messageOf([&] { const AtomicFile file(path); }).find("start what reads the pipe first") != std::string::npos);
    const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
    REQUIRE(reader >= 0);
    AtomicFile file(path);
    file.write("through");
    file.commit();
    std::array<char, 16> bytes {};
    CHECK(read(reader, bytes.data(), bytes.size()) == 7);
    CHECK(std::string(bytes.data()) == "through");
    close(reader);
}

TEST_CASE("a path that cannot be written is refused before the work, without a trace")
{
    const TempDirectory directory;
    checkWritable(directory / "new.exr");
    CHECK(directory.entries() == 0);
    writeBytes(directory / "file", "kept");
    checkWritable(directory / "file");
    CHECK(readBytes(directory / "file") == "kept");

    const auto check = [&](const std::string& path) { return messageOf([&] { checkWritable(path); }); };
    const std::string missing = directory / "no/such/a.exr";
    CHECK(check(missing)
        == "cannot write file (No such file or directory): " + missing
            + ": create the directory first, or write elsewhere");
    CHECK(check(directory.path())
        == "cannot write file (Is a directory): " + directory.path() + ": give the name of a file in it");
    CHECK(check((directory / "new") + "/").find("Is a directory") != std::string::npos);
    CHECK(check("") == "cannot write file (No such file or directory): (empty name): give a file name");
    CHECK(check((directory / "file") + "/a.exr").find("Not a directory") != std::string::npos);
    CHECK(check(directory / std::string(300, 'a')).find("use a shorter name") != std::string::npos);
    CHECK(directory.entries() == 1);
}

TEST_CASE("permissions are respected")
{
    const TempDirectory directory;
    // Anybody may replace files here, so that it is the file's own permission that counts.
    std::filesystem::permissions(directory.path(), std::filesystem::perms(0777));
    writeBytes(directory / "readonly", "kept");
    std::filesystem::permissions(directory / "readonly", std::filesystem::perms(0444));
    std::filesystem::create_directory(directory / "closed");
    std::filesystem::permissions(directory / "closed", std::filesystem::perms(0555));
    std::string inClosed;
    std::string onReadOnly;
    {
        const AsOrdinaryUser user;
        inClosed = messageOf([&] { checkWritable(directory / "closed/a.exr"); });
        onReadOnly = messageOf([&] { checkWritable(directory / "readonly"); });
    }
    CHECK(inClosed.find("Permission denied") != std::string::npos);
    CHECK(inClosed.find("check the permissions") != std::string::npos);
    CHECK(onReadOnly.find("Permission denied") != std::string::npos);
    CHECK(readBytes(directory / "readonly") == "kept");
}

TEST_CASE("a device is written directly, and a full one says so")
{
    AtomicFile nowhere("/dev/null");
    nowhere.write("gone");
    nowhere.commit();
    CHECK(std::filesystem::is_character_file("/dev/null"));
    const std::string message = messageOf([] {
        AtomicFile file("/dev/full");
        file.write("does not fit");
        file.commit();
    });
    CHECK(message == "cannot write file (No space left on device): /dev/full: free some space, or write elsewhere");
}

TEST_CASE("an image that does not fit leaves the old one and no temporary file")
{
    const TempDirectory directory;
    const RgbImage picture = noisyCard(64, 64, 1.0, 3);
    LayeredImage layered { 64, 64, { 0, 0, 64, 64 }, { { "R", std::vector<float>(4096), false } }, {} };
    for (std::size_t i = 0; i < 4096; ++i)
        layered.channels[0].values[i] = picture.rgb[i];
    writeBytes(directory / "a.exr", "old");
    std::string exr;
    std::string png;
    {
        const FileSizeLimit limit(1000);
        exr = messageOf([&] { writeExr(directory / "a.exr", layered); });
        png = messageOf([&] { writePng(directory / "b.png", picture); });
    }
    CHECK(exr == "cannot write file (File too large): " + (directory / "a.exr") + ": write elsewhere");
    CHECK(png == "cannot write file (File too large): " + (directory / "b.png") + ": write elsewhere");
    CHECK(readBytes(directory / "a.exr") == "old");
    CHECK(directory.entries() == 1);
    CHECK(messageOf([&] { writeExr(directory / "no/a.exr", layered); }).find("create the directory")
        != std::string::npos);
    CHECK(messageOf([&] { writePng(directory.path(), picture); }).find("Is a directory") != std::string::npos);
}
