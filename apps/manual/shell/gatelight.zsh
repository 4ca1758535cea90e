#compdef gatelight gatelight-mpi
# Completion of gatelight in zsh: source <(gatelight completion zsh). The program itself names the words that may follow.

_gatelight() {
  local program=${${(Q)words[1]}/#\~\//$HOME/} line
  local -a lines directive shown how
  program=$(whence -p -- "${program%-mpi}") || return 1
  lines=("${(@f)$("$program" __complete -- "${(@Q)words[2,CURRENT-1]}" "${(Q)PREFIX}" 2>/dev/null)}")
  [[ $lines[-1] == :* ]] || return 1
  directive=("${(@ps:\t:)lines[-1]}")
  for line in "${(@)lines[1,-2]}"; do
    line="${${line%%$'\t'*}//:/\\:}:${line#*$'\t'}"
    shown+=("${line%:}")
  done
  [[ $directive[1] == :open ]] && how=(-S '')
  local result=1
  (( $#shown )) && _describe 'gatelight' shown $how && result=0
  if [[ $directive[1] == :files || $directive[1] == :folders ]]; then
    compset -p $directive[2]
    if [[ $directive[1] == :folders ]]; then
      _files -/ && result=0
    elif [[ -n $directive[3] ]]; then
      _files -g "*.(${directive[3]// /|})(-.)" && result=0
    else
      _files && result=0
    fi
  fi
  return result
}

# From a folder of functions zsh runs this file at the first Tab.
if [[ $funcstack[1] == _gatelight ]]; then
  _gatelight "$@"
else
  compdef _gatelight gatelight gatelight-mpi
fi
