# Completion of scree in fish, by `scree complete`, which knows the commands and options.
function __scree_complete
    set -l typed (commandline -opc) (commandline -ct)
    set -l lines ($typed[1] complete $typed[2..-1] 2>/dev/null)
    set -l current (commandline -ct)
    switch $lines[1]
        case folders
            __fish_complete_directories $current ""
        case files
            __fish_complete_path $current
        case 'files *'
            __fish_complete_suffix $current .(string replace 'files ' '' -- $lines[1])
        case '*'
            printf '%s\n' $lines[2..-1]
    end
end
complete -c scree -f -a '(__scree_complete)'
