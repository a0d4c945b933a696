#!/bin/sh
# Makes the problems of this folder anew, with the program on the path: sh make.sh teeter
set -eu
cd "$(dirname "$0")"
teeter=${1:-teeter}
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT
export_problems() { # folder, scene, which, more arguments…
  folder=$1 scene=$2 when=$3
  shift 3
  "$teeter" run "$scene" --out "$runs/$folder" --quiet --force --export-problems "$folder" --export-when "$when" "$@"
}
export_problems hard row.toml hard --set solver.method=pgs
export_problems row row.toml every:75
export_problems crowd crowd.toml every:2
for scene in drop sliding free-rocking-on-ground free-rocking-on-beam; do
  case $scene in
    drop) every=every:1500 ;;
    sliding) every=every:200 ;;
    free-rocking-on-ground) every=every:5000 ;;
    *) every=every:2000 ;;
  esac
  export_problems scenarios "../../scenarios/$scene.toml" "$every"
done
