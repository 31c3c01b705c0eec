#compdef scree
# Completion of scree in zsh, by `scree complete`, which knows the commands and options.
local -a lines offers
lines=("${(@f)$($words[1] complete "${(@)words[2,CURRENT]}" 2>/dev/null)}")
local line
for line in "${(@)lines[2,-1]}"; do
    offers+=("${${line%%$'\t'*}//:/\\:}:${line#*$'\t'}")
done
[[ $lines[1] == f* && $PREFIX == -*=* ]] && compset -P '*='
case $lines[1] in
    folders) _files -/ ;;
    files) _files ;;
    files\ *) _files -g "*.${lines[1]#* }" ;;
    keys) _describe 'key' offers -S '' ;;
    *) _describe 'scree' offers ;;
esac
