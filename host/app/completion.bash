# Completes calls of wedge in bash: commands, their options, and values of those that choose among some, all of them as
# `wedge COMMAND --help` lists them; everything else is a file.
_wedge() {
    local program=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]} help values
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "render compare devices info --help --version" -- "$current")
        return
    fi
    # In bash "--method=mc" is three words.
    if [ "$current" = = ]; then
        current=
    elif [ "$option" = = ]; then
        option=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    help=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null) || return 0
    # "  --method mc|aaf   what it is" has the values of --method behind it.
    values=$(awk -v option="$option" '$1 == option && $2 ~ /^[a-z-]+(\|[a-z-]+)+$/ { gsub(/\|/, " ", $2); print $2 }' <<<"$help")
    if [ -n "$values" ]; then
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
    elif [[ $current == -* ]]; then
        values=$(sed -nE 's/^  (-[^ ]*).*/\1/p' <<<"$help" | sed -E 's/\{[^}]*\}//; s/,/ /g')
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    fi
}
complete -o filenames -F _wedge wedge
