// The folder in which a driver keeps its compiled kernels for us: what in it is ours to remove.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wedge::device {

/// A folder that can be had, or why not.
struct FolderOrReason {
    std::filesystem::path folder; ///< empty: there is none
    std::string reason; ///< then: a few words, the system's own where it has any
};

/// The folder wedge-pocl below root, made where it is not there yet. None is to be had without a root, where it cannot
/// be written, or where something of that name is not of our making. It is told by a file put in when it is made. It
/// has to belong to this user as well, since of folders that another user's driver makes in it this one's could write
/// to none, and would not build.
FolderOrReason ownCacheFolder(const std::filesystem::path& root);

/// A folder of this user's below one for temporary files (usually everybody's), made where it is not there yet: its
/// owner alone has access, and nobody else can have made it, or put another in its place. What others have made of that
/// name is passed over for another name.
FolderOrReason ownTemporaryFolder(const std::filesystem::path& temporary);

/// Why no file can be made in a folder, which is made if it is not there yet; "" where one can.
std::string whyUnwritable(const std::filesystem::path& folder);

/// Whether the disk of a folder has too little room for what a driver compiles for a frame or two: then PoCL ends the
/// process.
bool lacksRoom(const std::filesystem::path& folder);

/// A file that is open and locked (how: as flock has it), or -1. The lock goes with the process, however that ends.
int openLocked(const std::filesystem::path& path, int how);

/// Held while marks and the record are looked at or changed, so that nothing changes in between.
class Turn {
public:
    explicit Turn(const std::filesystem::path& folder);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    bool held() const { return file_ >= 0; }

private:
    int file_;
};

/// Removes what the driver left in the folder and the record of it, and nothing where it is not, or no longer, ours.
/// The folder stays: the driver of this process may have been told of it.
void emptyCacheFolder(const std::filesystem::path& folder);

/// The marks of processes in the folder: empty regular files that are named by a number.
std::vector<std::filesystem::path> marksIn(const std::filesystem::path& folder);

/// What the names of empty files begin with that say of some kernels that they are in the folder.
inline constexpr const char* knownKernels = "known-";

/// Removes those files: something of the folder was removed.
void forgetKnownKernels(const std::filesystem::path& folder);

/// The name of the mark of a process.
std::string markName(long process);

} // namespace wedge::device
