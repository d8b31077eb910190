# Sourced by `run` and `cross`, from the root of the checkout.
# shellcheck shell=bash
set -euo pipefail
# Sorting, character classes and the messages of the tools used must not depend on the machine.
export LC_ALL=C
export CARGO_INCREMENTAL=0 CARGO_NET_RETRY=5

tmp=$(mktemp -d)
current=
started=$SECONDS

# Whatever ends the script, the last line says which stage it was in.
finish() {
  local rc=$?
  rm -rf "$tmp"
  [ $rc = 0 ] || printf '\n== FAILED in "%s" after %d s (exit %d)\n' "${current:-start}" $((SECONDS - started)) $rc >&2
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

die() {
  printf '%s: %s\n' "$0" "$*" >&2
  exit 1
}

# stage NAME COMMAND...: a heading, the command, the seconds. `set -e` stops inside the command.
stage() {
  current=$1 started=$SECONDS
  shift
  printf '\n== %s\n' "$current"
  "$@"
  printf '== ok, %d s\n' $((SECONDS - started))
}

# retry SECONDS COMMAND...: for downloads. A second try has twice the time; apt and cargo resume what they have.
retry() {
  local limit=$1
  shift
  timeout "$limit" "$@" && return
  echo "failed or took more than $limit s, once more: $*" >&2
  timeout $((2 * limit)) "$@"
}

# hashes FILE COMMAND...: write every golden's tick hashes, as COMMAND (the program) computes them, into FILE.
hashes() {
  local out=$1 rc=0 expected files
  shift
  "$@" verify --hashes replays >"$out" </dev/null || rc=$?
  [ $rc = 0 ] || die "the goldens do not replay (exit $rc): $* verify --hashes replays"
  # A build that replays nothing agrees with every other build: count.
  expected=$(find replays -maxdepth 1 -name '*.replay' | wc -l)
  files=$(sed 's/ [^ ]* [^ ]*$//' "$out" | sort -u | wc -l)
  [ "$expected" -gt 0 ] || die "no golden in replays/"
  [ "$files" = "$expected" ] || die "replays/ has $expected goldens, the output has $files: $* verify --hashes replays"
  printf '%d goldens, %d ticks\n' "$files" "$(wc -l <"$out")"
}

# same NAME FILE NAME FILE: two builds' hashes must be equal byte by byte.
same() {
  cmp -s "$2" "$4" && return
  local line
  line=$(awk 'NR == FNR { a[++n] = $0; next } !(FNR in a) || $0 "" != a[FNR] "" { d = FNR; exit }
              END { print d ? d : FNR + 1 }' "$2" "$4")
  printf '%s\n' "$1 and $3 disagree, first at line $line (file, tick, hash):" >&2
  printf '  %-8s %s\n' "$1" "$(at_line "$line" "$2")" "$3" "$(at_line "$line" "$4")" >&2
  die "the replays depend on the build"
}
at_line() {
  sed -n "$1{p;q}" "$2" | grep . || echo "(ends before)"
}
