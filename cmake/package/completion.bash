# SPDX-License-Identifier: BSD-3-Clause
# Completion of the programs of repel in bash, from what their --help says: commands, options, the
# words that an option takes, and names of scenes.
_repel() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local top help commands words command=run
  top=$("$program" --help 2>/dev/null) || return
  help=$top
  commands=$(sed -nE '/^Commands:/,/^$/s/^  ([a-z]+) .*/\1/p' <<<"$top")
  if [ -n "$commands" ]; then
    # Without a command it is run.
    if [ "$COMP_CWORD" -gt 1 ] && grep -qxF -- "${COMP_WORDS[1]}" <<<"$commands"; then
      command=${COMP_WORDS[1]}
    fi
    help=$("$program" "$command" --help 2>/dev/null) || return
  fi
  if [[ $before == --* ]]; then
    # "--backend TEXT:{bullet,ode}=bullet" takes words, "--log TEXT" or "--secret FILE" a file.
    words=$(sed -nE "s/^  (-[a-z],)?$before [^{]*\{([^}]*)\}.*/\2/p" <<<"$help" | tr ',' ' ')
    if [ -n "$words" ]; then
      mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
      return
    fi
  fi
  if [[ $word == -* ]]; then
    words=$(sed -nE 's/^  (-[a-z],)?(--[a-z0-9-]+).*/\2/p' <<<"$help")
  else
    words=
    if grep -q '^  scene ' <<<"$help"; then
      words=$(sed -nE '/^Scenes/,/^[^ S]/s/^  ([a-z0-9_]+)$/\1/p' <<<"$top")
    fi
    if [ "$COMP_CWORD" -eq 1 ]; then words="$commands $words"; fi
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -F _repel teleop qualify robot_info step_response cover
