#!/usr/bin/env bash
# tests/packaging/install_test.sh FOLDER [MIRROR]: installs the Debian packages in FOLDER, where scripts/package.sh made them, on a
# clean Debian 12, which debootstrap makes, and tries there what they brought: program, scenes, templates, manual page,
# completion; the library, by building the example with Debian's compiler; last, that nothing is left when they are removed.
# Needs root, a mirror of Debian (MIRROR, or debootstrap's own) and 3 GB; about 5 minutes. Ends with "package: passed".
set -euo pipefail
if (($# < 1)); then
  echo "usage: tests/packaging/install_test.sh FOLDER [MIRROR]" >&2
  exit 2
fi
program=$(realpath "$1"/scree_*.deb)
library=$(realpath "$1"/libscree[0-9]*.deb)
development=$(realpath "$1"/libscree-dev_*.deb)
system=$(mktemp -d)
chmod 755 "$system" # mktemp keeps others out, and apt-get downloads as one of them
leave() {
  umount "$system/proc" 2>/dev/null || true
  rm -rf --one-file-system "$system"
}
trap leave EXIT

clean() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$system" "$@"; }
install() { clean apt-get install -q -y --no-install-recommends "$@" >"$system/tmp/apt.log" 2>&1 || { cat "$system/tmp/apt.log" >&2; exit 1; }; }
failed() {
  echo "package: FAILED: $*" >&2
  exit 1
}
# in_folder COMMAND: in a shell in the folder where a user of the clean system is.
in_folder() { clean bash -c "cd /home/user && $1"; }
# expect WORDS COMMAND: its output holds the words.
expect() {
  local said
  said=$(in_folder "$2" 2>&1) || failed "'$2' ended with status $?: $said"
  printf '$ %s\n%s\n\n' "$2" "$(tail -n 12 <<<"$said")"
  [[ $said == *"$1"* ]] || failed "'$2' did not say '$1'"
}

echo "== a clean system"
debootstrap --variant=minbase bookworm "$system" ${2:+"$2"} >"$system.log" 2>&1 || { tail -n 20 "$system.log" >&2; exit 1; }
rm "$system.log"
mount -t proc proc "$system/proc"
mkdir "$system/home/user"
cp "$program" "$library" "$development" "$system/tmp/"
clean apt-get -q update >/dev/null

echo "== the package, with what it depends on and nothing more"
install "/tmp/${program##*/}" "/tmp/${library##*/}"
names=(scree "$(basename "$library" | cut -d _ -f 1)" libscree-dev)
changed=$(clean dpkg --verify "${names[@]:0:2}")
[[ -z $changed ]] || failed "files that are not the packages': $changed"
version=$(clean dpkg-query -W -f '${Version}' scree)
expect "scree ${version%-*}" "scree --version"
expect "pictures   OSMesa" "scree info"
complaints=$(in_folder 'scree info 2>&1 >/dev/null')
[[ -z $complaints ]] || failed "scree info complains: $complaints"
expect "Next: scree plan hopper.yaml" "scree new hopper"
for template in drum minimal pile validation; do
  expect "Next: scree plan $template.yaml" "scree new $template"
  expect "memory " "scree plan $template.yaml"
done
# Without ffmpeg a run says so, and is a good run.
expect "warning: no movie" "scree run hopper.yaml --set render.fps=4"
expect ", 0 failed" "scree verify /usr/share/scree/configs/validation/{free_motion,resting,single_contact}"
expect "done at t = 0.2 s" "scree run /usr/share/scree/configs/11_dominoes.yaml --no-render --until 0.2 --set checks=[]"

echo "== what it recommends, and the programs that read its manual and its completion"
install ffmpeg gnuplot-nox man-db bash-completion zsh fish
expect "movie.mp4" "scree run hopper.yaml --overwrite --until 1.2 --set checks=[] --set render.fps=10; ls output/hopper/movie.mp4"
expect "scree run [OPTIONS] [SCENE]" "man --warnings=w scree | cat"
warnings=$(in_folder 'man --warnings=w scree 2>&1 >/dev/null')
[[ -z $warnings ]] || failed "man warns: $warnings"
manual=$(in_folder 'man scree | cat')
for section in NAME SYNOPSIS OPTIONS COMMANDS 'EXIT STATUS' ENVIRONMENT FILES EXAMPLES 'SEE ALSO'; do
  grep -q "^$section" <<<"$manual" || failed "no $section in the manual"
done
expect "scree ($version)" "zcat /usr/share/doc/scree/changelog.Debian.gz"
expect "Changelog" "zcat /usr/share/doc/scree/changelog.gz"
expect "License: Expat" "cat /usr/share/doc/scree/copyright"
# As bash loads it: by name, when TAB is pressed for the first time.
expect "hopper.yaml" ". /usr/share/bash-completion/bash_completion; _completion_loader scree; COMP_WORDS=(scree run h); COMP_CWORD=2; _scree; echo \"\${COMPREPLY[@]}\""
expect "hopper.yaml" "fish -c 'complete -C \"scree run h\"'"
expect "time.step=" "fish -c 'complete -C \"scree run hopper.yaml --set time.s\"'"
expect "_scree" "zsh -fc 'autoload -U compinit && compinit -u -D && echo \$_comps[scree]'"


echo "== a program of one's own, with the library and Debian's compiler, and no headers but the library's"
install "/tmp/${development##*/}" g++ cmake make pkg-config
changed=$(clean dpkg --verify libscree-dev)
[[ -z $changed ]] || failed "files that are not the package's: $changed"
arguments="/usr/share/scree/configs/01_bouncing_ball.yaml ball 'bodies[1].at[2]=3' time.end=10"
expect "Built target drop_height" "cp -r /usr/share/doc/libscree-dev/examples/drop_height . && cmake -S drop_height -B built && cmake --build built"
expect "held by body 0 with 361.6" "built/drop_height $arguments"
expect "held by body 0 with 361.6" "g++ -std=c++20 drop_height/main.cpp -o by_hand \$(pkg-config --cflags --libs scree) && ./by_hand $arguments"
expect "time has no stop (did you mean step?)" "built/drop_height /usr/share/scree/configs/01_bouncing_ball.yaml ball time.stop=1 || true"

echo "== removed"
mapfile -t files < <(for name in "${names[@]}"; do clean dpkg -L "$name"; done | grep /[a-z]*scree)
((${#files[@]} > 20)) || failed "the packages have ${#files[@]} files"
clean apt-get purge -q -y "${names[@]}" >/dev/null
left=$(clean ls -d "${files[@]}" 2>/dev/null || true)
[[ -z $left ]] || failed "left behind: $left"
echo "package: passed"
