# Completion of scree in bash, by `scree complete`, which knows the commands and options.
_scree() {
    # Bash cuts words at = and :, which are part of scree's.
    local word typed=() glue=
    for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
        if ((${#typed[@]} > 0)) && [[ $glue || $word == [=:]* ]]; then
            typed[-1]+=$word
        else
            typed+=("$word")
        fi
        glue=
        [[ $word == *[=:] ]] && glue=1
    done
    local current=${typed[-1]} files
    COMPREPLY=()
    {
        read -r files
        while IFS=$'\t' read -r word _; do COMPREPLY+=("${word#"${current%"${current##*[=:]}"}"}"); done
    } < <("${COMP_WORDS[0]}" complete "${typed[@]}" 2>/dev/null)

    [[ $files == keys ]] && compopt -o nospace 2>/dev/null
    current=${current##*=}
    [[ $files == f* ]] && compopt -o filenames 2>/dev/null
    case $files in
        folders) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
        files) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
        files\ *) mapfile -t COMPREPLY < <(compgen -d -- "$current"; compgen -f -X "!*.${files#* }" -- "$current") ;;
    esac
}
complete -F _scree scree
