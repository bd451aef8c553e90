# shellcheck shell=bash
# Sourced by ./collarmesh, tests/run and .ci/run: installs what is missing and builds.
: "${root:?is set by the script that sources this}"

build_dir=$root/build/release
binary=$build_dir/bin/collarmesh
stamp=$build_dir/.collarmesh-built
package_lists=/var/lib/dpkg/info

complain() {
  printf 'collarmesh: %s\n' "$@" >&2
}

# Run a command with its output in a log, which is shown when it fails.
logged() {
  local log=$1
  shift
  "$@" >>"$log" 2>&1 && return
  local code=$?
  grep -Ev '^\[ *[0-9]+[/%]' "$log" | tail -n 40 >&2
  return $code
}

# Print the packages of these groups (cmake/packages.txt) that are not installed.
missing_packages() {
  local group package
  for group in "$@"; do
    awk -v group="$group" '$1 == group { print $2 }' "$root/cmake/packages.txt"
  done | while read -r package; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
}

install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    complain "this is not a Debian system; install what cmake/packages.txt lists ($*) yourself"
    return 0
  fi
  local missing as_root=() log
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  missing=${missing//$'\n'/ }
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      complain "packages are missing and sudo is not there; as root, run: apt-get install $missing"
      return 1
    fi
    as_root=(sudo)
  fi
  complain "installing $missing"
  log=$(mktemp)
  # shellcheck disable=SC2086
  if logged "$log" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q update &&
    logged "$log" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y \
      -o DPkg::Lock::Timeout=300 install --no-install-recommends $missing; then
    rm -f "$log"
    return 0
  fi
  rm -f "$log"
  complain "could not install the packages; check the network and the messages above, or install by hand:" \
    "  apt-get install $missing"
  return 1
}

# Was a package that the program is built with installed or upgraded since the last build?
packages_changed() {
  local group package list
  while read -r group package; do
    [ "$group" = build ] || continue
    for list in "$package_lists/$package".list "$package_lists/$package":*.list; do
      [ "$list" -nt "$stamp" ] && return 0
    done
  done <"$root/cmake/packages.txt"
  return 1
}

# Is the program newer than every file it is made of?
up_to_date() {
  [ -x "$binary" ] && [ -f "$stamp" ] || return 1
  local parts=("$root/CMakeLists.txt" "$root/cmake" "$root/mesher") newer
  [ -d "$root/openmesh_io" ] && parts+=("$root/openmesh_io")
  [ -d "$root/freecad_workbench/brep" ] && parts+=("$root/freecad_workbench/brep")
  newer=$(find "${parts[@]}" \( -path "$root/mesher/doc" -o -path "$root/mesher/bench" -o -name __pycache__ \) -prune \
    -o -newer "$stamp" -print -quit)
  [ -z "$newer" ] && ! packages_changed
}

# build TARGET [CMAKE OPTION...]: configure and build in $build_dir, one process at a time.
build() {
  local target=$1 log=$build_dir/build.log generator=() code=0
  shift
  mkdir -p "$build_dir" || {
    complain "cannot write to $build_dir; make it writable or use a copy of the sources"
    return 1
  }
  exec 9>"$build_dir/.lock"
  command -v flock >/dev/null && flock 9
  # A folder that a developer has configured keeps its configuration.
  if [ ! -f "$build_dir/CMakeCache.txt" ]; then
    set -- -DCOLLARMESH_IN_GROUPS=ON "$@"
    ! command -v ninja >/dev/null || generator=(-G Ninja)
  fi
  : >"$log"
  : >"$stamp.begun"
  logged "$log" cmake -S "$root" -B "$build_dir" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release "$@" 9>&- &&
    logged "$log" cmake --build "$build_dir" --target "$target" --parallel "$(nproc)" 9>&- || code=$?
  if [ $code -eq 0 ]; then
    mv "$stamp.begun" "$stamp"
  else
    complain "the build failed: the messages above are the end of $log" \
      "if the cause is not in the sources, remove $build_dir and try again"
  fi
  exec 9>&-
  return $code
}
