#!/bin/bash
# Tests which packages the launcher installs, and how, with stand-ins for apt and similar programs.
set -u
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# stand_in NAME SCRIPT: a program of this name that comes first on the PATH.
stand_in() {
  printf '#!/bin/bash\n%s\n' "$2" >"$work/$1"
  chmod +x "$work/$1"
}

# expect DESCRIPTION EXIT-CODE OUTPUT-PATTERN: check the exit code and the output of `install_packages build`.
expect() {
  local output code=0
  output=$(export PATH="$work:$PATH" && . "$root/cmake/bootstrap.sh" && install_packages build 2>&1) || code=$?
  if [ "$code" -ne "$2" ] || ! grep -q -- "$3" <<<"$output"$'\n'"$(cat "$work/calls" 2>/dev/null)"; then
    printf 'FAILED: %s: exit code %d, wanted %d and "%s" in:\n%s\n' "$1" "$code" "$2" "$3" "$output"
    failures=$((failures + 1))
  fi
  rm -f "$work/calls"
}

stand_in apt-get "echo apt-get \"\$@\" >>$work/calls"
stand_in sudo "echo sudo \"\$@\" >>$work/calls; \"\$@\""
stand_in id 'echo 1000'

stand_in dpkg-query 'echo installed'
expect "nothing to do" 0 '^$'

stand_in dpkg-query 'case "$*" in *libcli11-dev*|*libdeflate-dev*) exit 1;; esac; echo installed'
expect "sudo when not root" 0 '^sudo env DEBIAN_FRONTEND=noninteractive apt-get -q update'
expect "what is missing, only" 0 'install --no-install-recommends libcli11-dev libdeflate-dev$'

stand_in dpkg-query 'case "$*" in *libhdf5-dev*|*libmedc-dev*|*libscotch-dev*) exit 1;; esac; echo installed'
expect "libraries of formats and partitions come with the first call" 0 \
  'install --no-install-recommends libhdf5-dev libmedc-dev libscotch-dev$'

stand_in id 'echo 0'
stand_in sudo "echo sudo >>$work/calls; exit 1"
expect "no sudo for root" 0 '^apt-get -q update'

stand_in dpkg-query 'echo config-files'
expect "a removed package is missing" 0 'install --no-install-recommends .*g++'

stand_in apt-get 'echo "E: no network"; exit 100'
expect "a failure shows why" 1 'E: no network'
expect "a failure says what to do" 1 'apt-get install .*libcgal-dev'

# built_anew DESCRIPTION EXIT-CODE PACKAGE: is the program built anew (exit code 1) after this package was
# installed?
built_anew() {
  local code=0
  : >"$work/info/$3"
  (. "$root/cmake/bootstrap.sh" && binary=/bin/true stamp=$work/stamp package_lists=$work/info && up_to_date) || code=$?
  if [ "$code" -ne "$2" ]; then
    printf 'FAILED: %s: exit code %d\n' "$1" "$code"
    failures=$((failures + 1))
  fi
  rm "$work/info/$3"
}

mkdir "$work/info"
: >"$work/stamp"
sleep 0.1
built_anew "a package of another use" 0 gmsh.list
built_anew "a library that comes later" 1 libmedc-dev.list
built_anew "a library for several architectures" 1 libhdf5-dev:amd64.list

[ $failures -eq 0 ]
