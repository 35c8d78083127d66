#!/bin/bash
# Dependencies point one way (the order of folders below), and only processes/node knows LCM.
# What is installed for clients needs nothing of this tree but the message types.
# Usage: includes_test.sh SOURCE_DIR
set -euo pipefail

# Lists "file: line: why" for each include that points the wrong way.
violations() {
  local root=$1
  # shellcheck disable=SC2016  # awk's dollars
  (cd "$root" && find common processes \( -name '*.h' -o -name '*.cc' \) -print0 | sort -z |
    xargs -0 --no-run-if-empty awk '
    BEGIN {
      rank["util"] = 0; rank["config"] = 1; rank["geometry"] = 2; rank["human"] = rank["calibration"] = 3
      rank["features"] = rank["map"] = rank["dataset"] = rank["simulation"] = 4
      rank["evaluation"] = rank["perception"] = 4
      rank["optimization"] = rank["check"] = 5
      node_room["node"] = 1; node_room["message"] = 0; node_room["log"] = 2  # of processes/node; itself is the room "node"
      node_room["bus"] = node_room["check"] = node_room["live"] = 3
      room["solver"] = 0; room["factors"] = 1; room["bundle"] = 2; room["window"] = 3  # of common/optimization
      clock = "<(thread|chrono|mutex|shared_mutex|condition_variable|future|ctime|time.h|sys/time.h|pthread.h)>"
    }
    function complain(why) { print FILENAME ": " $0 ": " why }
    FNR == 1 {
      split(FILENAME, path, "/")
      in_common = path[1] == "common"
      folder = path[2]
      if (in_common && !(folder in rank)) print FILENAME ": folder common/" folder " has no place in the order"
      is_node = !in_common && FILENAME ~ /_node\.(h|cc)$/
      is_installed = FILENAME ~ /^processes\/node\/message\/(codec|channels)\.h$/  # as in lcmtypes/CMakeLists.txt
      is_estimator = folder == "frontend" || folder == "human_tracker" || folder == "optimizer" || folder == "person_detector"
    }
    /kGroundTruth|"GROUND_TRUTH"/ && !in_common && is_estimator { complain("ground truth never reaches an estimator") }
    !/^[ \t]*#[ \t]*include/ { next }
    {
      target = $0
      gsub(/^[ \t]*#[ \t]*include[ \t]*["<]|[">].*$/, "", target)
      split(target, to, "/")
    }
    is_installed && (to[1] == "common" || to[1] == "processes") { complain("an installed header stands alone") }
    to[1] == "lcm" && (in_common || folder != "node") { complain("only processes/node includes lcm") }
    $0 ~ clock && (in_common || is_node) { complain("no clock and no thread in common/ and in nodes") }
    in_common && to[1] == "airdos" { complain("common/ knows no message types") }
    in_common && to[1] == "processes" { complain("common/ knows no processes") }
    in_common && to[1] == "common" && to[2] != folder && !(rank[to[2]] < rank[folder]) {
      complain("common/" folder " stands below common/" to[2] " or beside it")
    }
    in_common && folder == "optimization" && to[2] == folder && to[3] != path[3] && !(room[to[3]] < room[path[3]]) {
      complain("the room " path[3] " stands below " to[3])
    }
    !in_common && to[1] == "processes" && to[2] != folder && to[2] != "node" && folder != "tools" {
      complain("processes meet only at channels")
    }
    !in_common && folder == "tools" && to[2] == folder && to[3] != path[3] && to[3] != "progress" {
      complain("tools do not know each other")
    }
    folder == "node" && !in_common && to[1] == "processes" && to[2] == folder {
      here = path[4] == "" ? folder : path[3]
      there = to[4] == "" ? folder : to[3]
      if (here != there && !(node_room[there] < node_room[here])) complain("the room " here " stands below " there " or beside it")
    }
    folder == "node" && !in_common && to[1] == "processes" && to[2] != "node" { complain("node stands below the processes") }
    ')
}

fail() {
  echo "FAILED: $*"
  exit 1
}

# First that the check sees what it is there for.
fixture=$(mktemp -d)
trap 'rm -rf "$fixture"' EXIT
mkdir -p "$fixture"/common/{util,geometry,map,dataset,newcomer,optimization/{solver,factors,bundle,window}} "$fixture"/processes/{node/{bus,log,message},frontend,optimizer,tools/{map,replay}}
bad() { printf '%s\n' "$2" > "$fixture/$1"; }
bad common/util/a.h '#include "common/geometry/se3.h"'
bad common/map/b.cc '#include "common/dataset/stereo_sequence.h"'
bad common/geometry/c.cc '# include <lcm/lcm-cpp.hpp>'
bad common/geometry/d.h '#include "airdos/image_t.hpp"'
bad common/geometry/e.cc '  #include <chrono>'
bad common/dataset/f.cc '#include "processes/node/node.h"'
bad common/newcomer/g.h ''
bad processes/frontend/frontend_node.cc '#include <thread>'
bad processes/frontend/h.cc '#include "lcm/lcm-cpp.hpp"'
bad processes/frontend/i.cc '#include "processes/optimizer/optimizer_node.h"'
bad processes/node/j.cc '#include "processes/frontend/frontend_node.h"'
bad processes/optimizer/k.cc 'Subscribe(channel::kGroundTruth);'
bad common/optimization/factors/l.h '#include "common/optimization/bundle/bundle_problem.h"'
bad processes/tools/map/m.cc '#include "processes/tools/replay/replay.h"'
bad processes/node/log/n.cc '#include "processes/node/bus/bus.h"'
bad processes/node/message/o.cc '#include "processes/node/node.h"'
bad processes/node/message/codec.h '#include "common/util/check.h"'
readonly NUM_BAD=17
bad processes/node/bus/ok.cc '#include "processes/node/node.h"'
bad common/optimization/window/ok.cc '#include "common/optimization/solver/factor_graph.h"'
bad common/map/ok.cc '#include "common/util/ids.h"'
bad processes/node/message/channels.h '#include "airdos/image_t.hpp"'
bad processes/node/ok.cc '#include <lcm/lcm-cpp.hpp>'
bad processes/node/ok2.cc '#include <chrono>'
bad processes/tools/map/ok.cc '#include "processes/frontend/frontend_node.h"'
found=$(violations "$fixture")
files=$(cut -d: -f1 <<< "$found" | sort -u | wc -l)
((files == NUM_BAD)) || fail "the check sees $files of $NUM_BAD planted mistakes: $found"
! grep -q 'ok\|channels' <<< "$(cut -d: -f1 <<< "$found")" || fail "the check complains of what is right: $found"

found=$(violations "$1")
[[ -z $found ]] || fail "includes that point the wrong way:"$'\n'"$found"
echo "all includes point the right way"
