#compdef gatelight gatelight-mpi
# Completion of gatelight in zsh: source <(gatelight completion zsh). Where the program names no words, files follow.
_gatelight() {
  compadd -- ${(f)"$(${words[1]%-mpi} __complete "${(@)words[2,CURRENT]}" 2>/dev/null)"} || _files
}
# From a folder of functions zsh runs this file at the first Tab.
if [[ $funcstack[1] == _gatelight ]]; then _gatelight; else compdef _gatelight gatelight gatelight-mpi; fi
