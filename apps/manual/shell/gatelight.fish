# Completion of gatelight in fish: gatelight completion fish | source. The program itself names the words that may follow.

# Files that begin with the text, and have one of the extensions if there are any; of :folders only those.
function __gatelight_files -a kind stem
    set -l extensions $argv[3..-1]
    set -l place (string replace -r -- '^~/' "$HOME/" "$stem")
    for file in "$place"*
        set -l name (string replace -r -- '[^/]*$' '' "$stem")(string replace -r -- '.*/' '' $file)
        if test -d $file
            echo "$name/"
        else if test $kind = :files; and begin
                test -z "$extensions"; or contains -- (string match -r -- '[^.]*$' $file) $extensions
            end
            echo "$name"
        end
    end
end

function __gatelight_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    # Without its quotes, unless they are still open.
    set -l plain (string unescape -- $current); or set plain $current
    set -l program (string replace -r -- '-mpi$' '' (string replace -r -- '^~/' "$HOME/" $words[1]))
    command -q $program; or return
    set -l lines ($program __complete -- $words[2..-1] "$plain" 2>/dev/null)
    string match -q -- ':*' "$lines[-1]"; or return
    set -l directive (string split \t -- $lines[-1])
    test (count $lines) -gt 1; and printf '%s\n' $lines[1..-2]
    contains -- $directive[1] :files :folders; or return
    set -l begin (math $directive[2] + 1)
    set -l head (string sub -l $directive[2] -- "$plain")
    for file in (__gatelight_files $directive[1] (string sub -s $begin -- "$plain") (string split -n ' ' -- "$directive[3]"))
        echo "$head$file"
    end
end

complete -c gatelight -f -a '(__gatelight_complete)'
complete -c gatelight-mpi -f -a '(__gatelight_complete)'
