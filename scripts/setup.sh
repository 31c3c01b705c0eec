# shellcheck shell=bash
# What ./run, ./test and .ci/run share: packages, compiler, build. Sourced.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

packages="$root/cmake/packages.txt"

# stage NAME COMMAND...: runs it and prints one line with its wall time; ends the script if it fails.
stage() {
  local name=$1 start=$EPOCHREALTIME status=0
  shift
  "$@" || status=$?
  local tenths=$(((${EPOCHREALTIME/./} - ${start/./}) / 100000))
  printf '%-34s %4d.%d s%s\n' "$name" $((tenths / 10)) $((tenths % 10)) "$( ((status == 0)) || echo '   FAILED')"
  ((status == 0)) || exit "$status"
}

package_names() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$packages"; }

missing_packages() {
  local installed
  # dpkg-query fails when it does not know one of the names, which is what is asked here.
  # shellcheck disable=SC2016  # the dollars are dpkg's
  installed=$({ package_names | xargs dpkg-query -W -f '${db:Status-Status} ${Package}\n' 2>/dev/null || true; } |
    sed -n 's/^installed //p')
  comm -23 <(package_names | sort -u) <(sort -u <<<"$installed")
}

# ensure_packages [LIST]: installs what cmake/packages.txt, or the list, names and the machine lacks. The copy left in
# build/ says that this list has been seen to, so that later calls cost nothing.
ensure_packages() {
  packages=${1:-$packages}
  local seen="$root/build/${packages##*/}" missing as_root=()
  if cmp -s "$packages" "$seen"; then return; fi
  if ! command -v dpkg-query >/dev/null; then
    echo "Not a Debian system: going on with what is installed (${packages#"$root/"} names what is needed)." >&2
    return
  fi
  mapfile -t missing < <(missing_packages)
  if ((${#missing[@]} > 0)); then
    if ((EUID != 0)); then
      if ! command -v sudo >/dev/null; then
        echo "Debian packages are missing, and only root can install them. As root, run" >&2
        echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}" >&2
        exit 2
      fi
      as_root=(sudo)
    fi
    stage "install ${#missing[@]} packages" install_packages
  fi
  mkdir -p "$root/build"
  cp "$packages" "$seen"
}

install_packages() {
  echo "Installing with apt-get: ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o Dpkg::Use-Pty=0) log
  log=$(mktemp)
  if "${apt[@]}" update >"$log" 2>&1 </dev/null &&
    "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1 </dev/null; then
    rm "$log"
  else
    cat "$log" >&2
    rm "$log"
    return 1
  fi
}

have_nvcc() { PATH="$PATH:/usr/local/cuda/bin" command -v nvcc >/dev/null; }
# A GPU that a program here could run on: its driver has made a device of it, and answers.
have_gpu() { compgen -G '/dev/nvidia[0-9]*' >/dev/null || nvidia-smi -L 2>/dev/null | grep -q '^GPU '; }

# Compilations at once: as many as there are cores, and as the free memory holds at 2 GB for nvcc on Thrust.
build_jobs() {
  local by_memory
  by_memory=$(awk '/^MemAvailable:/ {print int($2 / 2097152)}' /proc/meminfo)
  local jobs
  jobs=$(nproc)
  ((by_memory < jobs)) && jobs=$by_memory
  echo $((jobs > 0 ? jobs : 1))
}

# build PRESET [TARGET...]: configures if that was never done (ninja does it again when it is needed) and builds.
build() {
  local preset=$1
  shift
  if [[ ! -f "$root/build/$preset/build.ninja" ]]; then
    (cd "$root" && cmake --preset "$preset" --log-level=WARNING >/dev/null)
  fi
  local quiet=--quiet # ninja's progress is one line on a terminal, and thousands elsewhere
  [[ -t 1 ]] && quiet=
  ninja -C "$root/build/$preset" -j "$(build_jobs)" $quiet "$@"
}
