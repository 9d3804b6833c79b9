#!/bin/bash
# What the drawings cannot draw, or must not write, they name in one sentence, with the file.
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
sed 's/^1,0,/1,0.25,/' "$folder/taught.csv" >"$folder/elsewhere.csv"
sed 's/^0,/7,/; s/^1,/8,/' "$folder/taught.csv" >"$folder/later.csv"
sed 's/tau_h_elbow/tau_elbow/' "$folder/taught.csv" >"$folder/loaded.csv"
sed 's/,tau_h_/,tau_elbow,tau_h_/; s/^\([01],0\),/\1,3,/' "$folder/taught.csv" >"$folder/made.csv"
echo '{"provenance": {"parent": "demo_7.csv"}}' >"$folder/made.json"
sed 's/0.5,0.1$/NaN,NaN/' "$folder/taught.csv" >"$folder/unknown.csv"
sed 's/tau_h_/effort_/g' "$folder/taught.csv" >"$folder/plain.csv"
sed 's/elbow/wrist/g' "$folder/taught.csv" >"$folder/other.csv"
printf '\x89PNG\xff\n' >"$folder/picture.csv"
cp "$folder/taught.csv" "$folder/torn.csv"
echo '{"id":' >"$folder/torn.json"

failed=0
script=draw_human_torque.py
expect() {  # a status, a sentence, the script's arguments
  local status=0 said
  said=$(cd "$folder" && "$project/scripts/$script" "${@:3}" 2>&1) || status=$?
  [ "$status" = "$1" ] && [ "$said" = "$2" ] || { echo "${*:3}: exit $status, \"$said\"; expected $1, \"$2\""; failed=1; }
}
refused="$script:"
expect 0 "taught.png" taught.csv
expect 2 "$refused taught.png: exists already and is not overwritten; choose another name, or add --force" taught.csv
expect 0 "taught.png" taught.csv --live taught.csv --force
expect 0 "bare" taught.csv -o bare
head -c 4 "$folder/bare" | grep -q PNG || { echo "bare: is no PNG, or is not there"; failed=1; }
expect 2 "$refused absent.csv: cannot be read: No such file or directory" absent.csv
expect 2 "$refused picture.csv: no text, byte 0 is not UTF-8; is it a demonstration?" picture.csv
ln -s /dev/zero "$folder/endless.csv"
expect 2 "$refused endless.csv: is no regular file; is it a demonstration?" endless.csv
expect 2 "$refused torn.json: no JSON: Expecting value: line 2 column 1 (char 7)" torn.csv
expect 2 "$refused absent/taught.png: cannot be written: No such file or directory" taught.csv -o absent/taught.png
expect 2 "$refused plain.csv: no column tau_h_<joint> to draw; \`demo_tool torque\` adds them" plain.csv
expect 2 "$refused unknown.csv: the columns tau_h_elbow hold no number; \`demo_tool check\` says which inputs are missing" \
  unknown.csv
expect 2 "$refused other.csv: joints wrist, expected those of taught.csv, elbow, which --live is the recording of" \
  taught.csv --live other.csv -o new.png
expect 2 "$refused --live elsewhere.csv: q_elbow is 0.25 at 1 s, expected 0 as in taught.csv, which it is the recording of" \
  taught.csv --live elsewhere.csv -o new.png
expect 2 "$refused --live later.csv: 7 to 8 s, none of them a time of made.csv, which was made of demo_7.csv" \
  made.csv --live later.csv -o new.png
expect 2 "$refused --live loaded.csv: tau_elbow is 0.5 at 0 s, expected 3 as in made.csv, which was made of demo_7.csv" \
  made.csv --live loaded.csv -o new.png
for script in draw_human_torque.py draw_demonstration.py; do
  expect 2 "$script: /dev/full: cannot be written: No space left on device" taught.csv -o /dev/full
  expect 2 "$script: new.txt: no kind of picture ends in .txt, expected .png, .svg or .pdf" taught.csv -o new.txt
  expect 2 "$script: taught.csv: is the recording itself, expected another name for its picture" \
    taught.csv -o taught.csv --force
  expect 2 "$script: taught.png: exists already and is not overwritten; choose another name, or add --force" taught.csv
done
[ ! -e /dev/full.png ] || { echo "/dev/full.png was written"; failed=1; }
[ ! -e "$folder/new.png" ] || { echo "new.png was written"; failed=1; }
exit $failed
