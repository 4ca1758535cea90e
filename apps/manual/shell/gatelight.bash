# Completion of gatelight in bash: source <(gatelight completion bash). The program itself names the words that may
# follow.

# Words of the command line up to the cursor, without quotes, in `words`. bash parts them at ':' and '=' too: `before` is
# the part of the last one that it leaves as it is.
_gatelight_words() {
  local rest=${COMP_LINE-} word i apart blank
  [[ -n $rest ]] && rest=${rest:0:COMP_POINT}
  words=() before=
  for ((i = 0; i <= COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]-} apart=yes
    if [[ -n ${COMP_LINE-} ]]; then
      blank=${rest%%[![:space:]]*}
      [[ -z $blank && $i -gt 0 ]] && apart=
      rest=${rest#"$blank"}
      ((${#word} > ${#rest})) && word=$rest
      rest=${rest:${#word}}
    fi
    quoted=$word
    word=${word//[\"\'\\]/} word=${word/#'$HOME/'/$HOME/}
    if [[ $apart ]]; then
      words+=("$word") before=
    else
      before=${words[-1]}
      words[-1]+=$word
    fi
  done
  [[ $word == [:=] ]] && before=${words[-1]} quoted=
}

# Adds the files that begin with $1, without their first $4 characters: folders and, where $2 is :files, those with one of
# the extensions $3, or all where it is empty.
_gatelight_files() {
  local file place
  while IFS= read -r file; do
    place=${file/#'~/'/$HOME/}
    if [[ -d $place ]] || [[ $2 == :files && ( -z $3 || " $3 " == *" ${file##*.} "* ) ]]; then
      COMPREPLY+=("${file:$4}")
    fi
  done < <(compgen -f -- "$1")
  compopt -o filenames 2>/dev/null
}

_gatelight() {
  local -a words lines directive
  local before quoted program line word
  _gatelight_words
  COMPREPLY=()
  program=${words[0]/#'~/'/$HOME/}
  program=$(type -P "${program%-mpi}") || return 0
  mapfile -t lines < <("$program" __complete -- "${words[@]:1}" 2>/dev/null)
  [[ ${lines[-1]-} == :* ]] || return 0
  IFS=$'\t' read -r -a directive <<<"${lines[-1]}"
  unset 'lines[-1]'
  for line in "${lines[@]}"; do
    word=${line%%$'\t'*}
    word=${word:${#before}}
    [[ $word == *[!A-Za-z0-9_.,:=/+@%-]* && $quoted != [\"\']* ]] && printf -v word %q "$word"
    COMPREPLY+=("$word")
  done
  case ${directive[0]} in
    :open) compopt -o nospace 2>/dev/null ;;
    :files | :folders)
      local begin=${directive[1]-0}
      _gatelight_files "${words[-1]:begin}" "${directive[0]}" "${directive[2]-}" \
        $((${#before} > begin ? ${#before} - begin : 0))
      ;;
  esac
}

complete -F _gatelight gatelight gatelight-mpi
