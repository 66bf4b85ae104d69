# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# Completion of aib-lua in bash: options, protocols by name and their own options, files.

_aib_lua() {
  local word=${COMP_WORDS[COMP_CWORD]} i script=
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${COMP_WORDS[i]} in
      -e | -l | --threads | --read | --write | --memory | --seconds | --instructions) ((++i)) ;;
      -*) ;;
      *) script=${COMP_WORDS[i]} && break ;;
    esac
  done

  local choices=
  if [[ $word == -* ]]; then
    # What --help says: of the shell, or of the protocol that stands before.
    choices=$("${COMP_WORDS[0]}" ${script:+"$script"} --help 2>/dev/null | grep -oE '(^|[ ,])--?[a-zA-Z][a-z_-]*')
  elif [[ -z $script ]]; then
    choices=$("${COMP_WORDS[0]}" --list 2>/dev/null | cut -d ' ' -f 1)
  fi
  mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word"; [[ $word == -* ]] || compgen -f -- "$word")
}
complete -o filenames -F _aib_lua aib-lua
