# Completion of gatelight in fish: gatelight completion fish | source. It names words of the program beside files.
function __gatelight_words
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l program (string replace -r -- '-mpi$' '' $words[1])
    $program __complete $words[2..-1] "$current" 2>/dev/null
end
complete -c gatelight -a '(__gatelight_words)'
complete -c gatelight-mpi -a '(__gatelight_words)'
