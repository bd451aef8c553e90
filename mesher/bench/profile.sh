#!/bin/sh
# Where refinement's time goes: a flat profile of mesher/bench's `refine` on one core.
#   profile.sh INPUT SIZE [BUILD]      (BUILD: a folder configured with COLLARMESH_BENCH)
# Needs linux-perf and a kernel.perf_event_paranoid of at most 2.
set -eu
if [ $# -lt 2 ]; then
  echo "usage: profile.sh INPUT SIZE [BUILD]" >&2
  exit 2
fi
build=${3:-$(dirname "$0")/../../build/bench}
data=$(mktemp)
trap 'rm -f "$data"' EXIT
perf record --quiet --freq 999 --output "$data" "$build/bin/refine" "$1" "$2"
perf report --input "$data" --stdio --no-children --percent-limit 1 --sort symbol 2>/dev/null |
  sed -e '/^#/d' -e '/^$/d' -e 's/collarmesh:://g' | cut -c 1-110 | sed -e 's/ *$//'
