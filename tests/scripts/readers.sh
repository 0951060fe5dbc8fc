#!/usr/bin/env bash
# readers.sh SOURCE: all that a result is made from is opened by openFile() (host/file.h), since outputs are held against what that
# notes. Names what opens files otherwise, but for the files below, which write, or keep caches, or look at outputs.
set -euo pipefail
cd "$1"

allowed=(
    host/app/console.cpp         # standard streams that are closed
    host/app/rescue.cpp          # makes a new file
    host/device/cache_folder.cpp host/device/cache_record.cpp host/device/driver_cache.cpp host/device/program_cache.cpp # caches
    host/file.cpp                # openFile() itself
    host/image/atomic_file.cpp   # outputs
    host/image/png_write.cpp     # whether a picture is one of wedge's, which is then replaced
    host/render/compilers.cpp    # marks in a cache
)
openers='ifstream|fstream\b|ofstream|\bfopen\(|\bopen\([^)]*O_|\bopenat\(|filebuf|\bmmap\(|parse_file|InputFile [a-z]+\([a-z]*[pP]ath|read_from_file|stbi_load\(|LoadObj[A-Za-z]*\([^)]*\.c_str'

found=$(grep -rnE "$openers" --include='*.cpp' --include='*.h' host effects filters bvh | grep -v '#include' || true)
for file in "${allowed[@]}"; do
    [ -e "$file" ] || { echo "readers.sh: error: no such file, take it off the list: $file"; exit 1; }
    found=$(grep -v "^$file:" <<<"$found" || true)
done
if [ -n "$found" ]; then
    echo "opened past openFile(), so that an output may overwrite it:"
    echo "$found"
    exit 1
fi
