# Completion of gatelight in bash: source <(gatelight completion bash). Where the program names no words, files follow.
_gatelight() {
  mapfile -t COMPREPLY < <(compgen -W "$("${1%-mpi}" __complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)" -- "$2")
}
complete -o default -F _gatelight gatelight gatelight-mpi
