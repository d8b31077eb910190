# Sourced by `run`, from the root of the checkout.
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
