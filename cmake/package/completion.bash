# SPDX-License-Identifier: BSD-3-Clause
# Completion of the programs of repel in bash, from what their --help says: options, the words that
# an option takes, and names of scenes.
_repel() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local help words
  help=$("$program" --help 2>/dev/null) || return
  if [[ $before == --* ]]; then
    # "--backend TEXT:{bullet,ode}=bullet" takes words, "--log TEXT" or "--secret FILE" a file.
    words=$(sed -nE "s/^ *(-[a-z],)?$before [^{]*\{([^}]*)\}.*/\2/p" <<<"$help" | tr ',' ' ')
    if [ -n "$words" ]; then
      mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
      return
    fi
  fi
  if [[ $word == -* ]]; then
    words=$(sed -nE 's/^ *(-[a-z],)?(--[a-z0-9-]+).*/\2/p' <<<"$help")
  else
    words=$(sed -nE '/^Scenes/,/^[^ S]/s/^  ([a-z0-9_]+)$/\1/p' <<<"$help")
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -F _repel teleop qualify robot_info cover
