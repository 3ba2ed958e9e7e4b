#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# examples/three_scales.sh [MESH [FOLDER]]: one sampling, three scales. How does the axis get simpler as they grow?
# The program is `scaleaxis` on the PATH, or what SCALEAXIS names. The README shows this, too.

set -eu
mesh=${1-data/cat.obj}
folder=${2-out}
mkdir -p "$folder"
"${SCALEAXIS-scaleaxis}" axis "$mesh" --delta 0.02 --scale 1.05,1.1,1.5 \
    --output "$folder/" --stats "$folder/statistics.json" --quiet
python3 - "$folder/statistics.json" <<'END'
import json, sys
for axis in json.load(open(sys.argv[1]))["results"][0]["axes"]:
    print("s = {scale}: {hidden_balls} of {balls} balls hidden, {result[sheets]} sheets: {file}".format(**axis))
END
