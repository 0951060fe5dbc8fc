#!/usr/bin/env bash
# docs_code.sh ROOT: fails if a page of docs/ shows code that is not there. Such a block follows a line "<!-- code: PATH -->", and its
# lines are in that file, one after the other, however far they are indented.
set -euo pipefail
cd "${1:?docs_code.sh: error: no folder of the sources: name it}"

status=0
found=0
for page in docs/*.md; do
    mapfile -t lines <"$page"
    for ((i = 0; i < ${#lines[@]}; ++i)); do
        [[ ${lines[i]} =~ ^'<!-- code: '(.*)' -->'$ ]] || continue
        file=${BASH_REMATCH[1]}
        block=
        for ((i += 2; i < ${#lines[@]}; ++i)); do
            [ "${lines[i]}" != '```' ] || break
            block+="${lines[i]#"${lines[i]%%[![:space:]]*}"}"$'\n'
        done
        found=$((found + 1))
        if [[ $(sed 's/^[[:space:]]*//' "$file")$'\n' != *"$block"* ]]; then
            echo "docs_code: $page shows code that is not in $file" >&2
            status=1
        fi
    done
done
if [ "$found" -eq 0 ]; then
    echo "docs_code: no page shows code" >&2
    exit 1
fi
exit $status
