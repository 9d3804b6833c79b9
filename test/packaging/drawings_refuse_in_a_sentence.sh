#!/bin/bash
# What draw_human_torque.py cannot draw it names in one sentence, with the file.
set -euo pipefail
project=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
/usr/bin/python3 -c 'import matplotlib, numpy' 2>/dev/null || { echo "skipped: needs python3-matplotlib"; exit 77; }

cat >"$folder/taught.csv" <<'END'
time,q_elbow,tau_h_elbow,tau_h_std_elbow
0,0,0.5,0.1
1,0,0.5,0.1
END
sed 's/0.5,0.1$/NaN,NaN/' "$folder/taught.csv" >"$folder/unknown.csv"
sed 's/tau_h_/effort_/g' "$folder/taught.csv" >"$folder/plain.csv"
sed 's/elbow/wrist/g' "$folder/taught.csv" >"$folder/other.csv"
printf '\x89PNG\xff\n' >"$folder/picture.csv"
cp "$folder/taught.csv" "$folder/torn.csv"
echo '{"id":' >"$folder/torn.json"

failed=0
expect() {  # a status, a sentence, the script's arguments
  local status=0 said
  said=$(cd "$folder" && "$project/scripts/draw_human_torque.py" "${@:3}" 2>&1) || status=$?
  [ "$status" = "$1" ] && [ "$said" = "$2" ] || { echo "${*:3}: exit $status, \"$said\"; expected $1, \"$2\""; failed=1; }
}
refused="draw_human_torque.py:"
expect 0 "taught.png" taught.csv
expect 0 "taught.png" taught.csv --live taught.csv
expect 2 "$refused absent.csv: cannot be read: No such file or directory" absent.csv
expect 2 "$refused picture.csv: no text, byte 0 is not UTF-8; is it a demonstration?" picture.csv
expect 2 "$refused torn.json: no JSON: Expecting value: line 2 column 1 (char 7)" torn.csv
expect 2 "$refused absent/taught.png: cannot be written: No such file or directory" taught.csv -o absent/taught.png
expect 2 "$refused plain.csv: no column tau_h_<joint> to draw; \`demo_tool torque\` adds them" plain.csv
expect 2 "$refused unknown.csv: the columns tau_h_elbow hold no number; \`demo_tool check\` says which inputs are missing" \
  unknown.csv
expect 2 "$refused other.csv: joints wrist, expected those of taught.csv, elbow, which --live is the recording of" \
  taught.csv --live other.csv
exit $failed
