// What is no regular file, or cannot be read, wherever a file is read: nothing is waited for or read without end.
#include "tests/hostile/row.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace wedge::hostile {
namespace {

struct Kind {
    const char* name;
    void (*make)(const Folder& path);
};

void makeSocket(const Folder& path)
{
    // Names of sockets are short: made in the folder itself.
    const Folder before = std::filesystem::current_path();
    std::filesystem::current_path(path.parent_path());
    sockaddr_un address {};
    address.sun_family = AF_UNIX;
    path.filename().string().copy(address.sun_path, sizeof address.sun_path - 1);
    const int handle = socket(AF_UNIX, SOCK_STREAM, 0);
    (void)bind(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    close(handle);
    std::filesystem::current_path(before);
}

const Kind kinds[] = {
    { "a pipe", [](const Folder& path) { mkfifo(path.c_str(), 0666); } },
    { "a folder", [](const Folder& path) { std::filesystem::create_directory(path); } },
    { "a socket", makeSocket },
    { "a link to nowhere", [](const Folder& path) { std::filesystem::create_symlink("gone", path); } },
    { "a link to itself", [](const Folder& path) { std::filesystem::create_symlink(path.filename(), path); } },
    { "a link to /dev/zero", [](const Folder& path) { std::filesystem::create_symlink("/dev/zero", path); } },
    { "a link to /dev/null", [](const Folder& path) { std::filesystem::create_symlink("/dev/null", path); } },
    { "a link to /proc/self/mem", [](const Folder& path) { std::filesystem::create_symlink("/proc/self/mem", path); } },
    { "empty", [](const Folder& path) { write(path.parent_path(), path.filename(), ""); } },
    { "16 GB of nothing",
        [](const Folder& path) {
            write(path.parent_path(), path.filename(), "");
            std::filesystem::resize_file(path, std::uintmax_t { 16 } << 30);
        } },
    { "unreadable",
        [](const Folder& path) {
            write(path.parent_path(), path.filename(), "v 0 0 0\n");
            std::filesystem::permissions(path, std::filesystem::perms::none);
        } },
};

struct Use {
    const char* name;
    const char* file;
    Arguments call;
    Ending ending;
};

/// Where a file can be named. Libraries and the textures that they name are dispensable.
std::vector<Use> uses()
{
    return { { "the scene", "x.toml", { "info", "x.toml" }, Ending::Failure },
        { "a mesh as the scene", "x.obj", { "info", "x.obj" }, Ending::Failure },
        { "a mesh", "x.obj", { "info", "mesh.toml" }, Ending::Failure },
        { "a shape", "x.obj", { "info", "shape.toml" }, Ending::Failure },
        { "a scene's library", "x.mtl", { "info", "library.toml" }, Ending::DoneOrFailure },
        { "a mesh's library", "x.mtl", { "info", "library.obj" }, Ending::Done },
        { "a scene's texture", "x.png", { "info", "texture.toml" }, Ending::Failure },
        { "a library's texture", "x.png", { "info", "texture.obj" }, Ending::Done },
        { "a PNG", "x.png", { "compare", "x.png", "x.png" }, Ending::Failure },
        { "an EXR", "x.exr", { "compare", "x.exr", "x.exr" }, Ending::Failure },
        { "an HDR", "x.hdr", { "compare", "x.hdr", "x.hdr" }, Ending::Failure },
        { "the reference", "x.exr", tiny({ "--reference", "x.exr", "-o", "a.exr" }), Ending::Failure } };
}

void writeUsers(const Folder& folder)
{
    write(folder, "m.obj", triangle);
    write(folder, "mesh.toml", "[[mesh]]\nfile = 'x.obj'\n");
    write(folder, "shape.toml",
        "[shutter]\nclose = 1\n[[mesh]]\nfile = 'm.obj'\nshape = [{ time = 0, file = 'm.obj' }, { time = 1, file = "
        "'x.obj' }]\n");
    write(folder, "library.toml", "[[mesh]]\nfile = 'm.obj'\nmtl = 'x.mtl'\n");
    write(folder, "library.obj", "mtllib x.mtl\nusemtl m\n" + triangle);
    write(folder, "texture.toml",
        "[[material]]\nname = 'm'\ndiffuse_texture = 'x.png'\n[[mesh]]\nfile = 'm.obj'\nmaterial = 'm'\n");
    write(folder, "texture.obj", "mtllib t.mtl\nusemtl m\n" + triangle);
    write(folder, "t.mtl", "newmtl m\nmap_Kd x.png\n");
}

} // namespace

Rows fileKindRows()
{
    Rows rows;
    for (const Kind& kind : kinds) {
        for (const Use& use : uses()) {
            const std::string file = use.file;
            Row row { .name = std::string(use.name) + ": " + kind.name,
                .call = use.call,
                .prepare =
                    [=](const Folder& folder) {
                        writeUsers(folder);
                        kind.make(folder / file);
                    },
                .ending = use.ending,
                .says = file };
            row.start.ordinaryUser = std::string(kind.name) == "unreadable";
            const bool hasNothing =
                std::string(kind.name) == "empty" || std::string(kind.name) == "a link to /dev/null";
            if (hasNothing && (file == "x.toml" || file == "x.mtl")) { // no more than an odd scene or library
                row.ending = Ending::DoneOrFailure;
                row.says = "";
            }
            rows.push_back(row);
        }
    }
    return rows;
}

} // namespace wedge::hostile
