#!/bin/bash
# Adds to the files of the packages what is made from them: man pages, units, copyright, changelog.
# Usage: finish.sh SOURCE_DIR STAGE VERSION MAINTAINER
#   STAGE holds runtime/usr, dev/usr and doc/usr.
set -euo pipefail

readonly source_dir=$1 stage=$2 version=$3 maintainer=$4
readonly runtime=$stage/runtime/usr
work=$(mktemp -d)
readonly work
trap 'rm -rf "$work"' EXIT

# Time of the files that are made here, so that the same commit gives the same package.
date=@${SOURCE_DATE_EPOCH:-$(date +%s)}
readonly date

# description_of HELP: its first sentence, with a small letter.
description_of() {
  local text
  text=$(sed '/^$\|^Usage:/,$d' "$1" | tr '\n' ' ')
  text=${text%% }
  text=${text%%. *}
  text=${text%.}
  printf '%s%s' "$(tr '[:upper:]' '[:lower:]' <<< "${text:0:1}")" "${text:1}"
}

# man_page COMMAND: from its --help, and that of its subcommands.
man_page() {
  local command=$1 help=$work/help subcommand
  local -a include=()
  "$runtime/bin/$command" --help > "$help"
  : > "$work/include"
  while read -r subcommand; do
    {
      echo "[command $subcommand]"
      echo '.nf'
      "$runtime/bin/$command" "$subcommand" --help | sed 's/\\/\\e/g; s/^\([.'\'']\)/\\\&\1/; s/-/\\-/g'
      echo '.fi'
    } >> "$work/include"
    include=(--include="$work/include")
  done < <(sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\) .*/\1/p' "$help")
  help2man --no-info --section=1 --manual='AirDOS' --source="AirDOS ${version%-*}" --name="$(description_of "$help")" \
    "${include[@]}" --output="$work/page" "$runtime/bin/$command"
  # Where the programs stand now is not where they are installed. help2man escapes dots, dashes and backslashes.
  # shellcheck disable=SC2001 # the shell's own substitution cannot repeat what it found
  sed "s|$(sed 's/[.\-]/\\\\*&/g' <<< "$stage/runtime")||g" "$work/page" | gzip -9n > "$runtime/share/man/man1/$command.1.gz"
}

mkdir -p "$runtime/share/man/man1"
export HOME=/nowhere XDG_STATE_HOME= # no page tells of whoever built it
for program in "$runtime"/bin/*; do man_page "$(basename "$program")"; done

readonly units=$runtime/lib/systemd/system
mkdir -p "$units/airdos@map-recorder.service.d" "$units/airdos@stereo-camera.service.d"
install -m 644 "$source_dir"/packaging/systemd/airdos* "$units"
install -m 644 "$source_dir/packaging/systemd/map-recorder.conf" "$units/airdos@map-recorder.service.d/run-dir.conf"
install -m 644 "$source_dir/packaging/systemd/stereo-camera.conf" "$units/airdos@stereo-camera.service.d/devices.conf"

cat > "$work/changelog" << END
airdos ($version) bookworm; urgency=medium

  * Release ${version%-*}; what is new stands in changelog.gz.

 -- $maintainer  $(date -u -R -d "$date")
END
find "$stage" -mindepth 1 -type d -empty -delete
for component in runtime:airdos dev:airdos-dev doc:airdos-doc; do
  folder=$stage/${component%%:*}/usr/share/doc/${component#*:}
  mkdir -p "$folder"
  install -m 644 "$source_dir/packaging/debian/copyright" "$folder/copyright"
  gzip -9nc "$work/changelog" > "$folder/changelog.Debian.gz"
  gzip -9nc "$source_dir/CHANGELOG.md" > "$folder/changelog.gz"
  find "$stage/${component%%:*}" -newermt "$(date -d "$date" '+%F %T')" -exec touch -h -d "$date" {} +
done
