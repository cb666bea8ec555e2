# SPDX-License-Identifier: BSD-3-Clause
"""03_plot_a_run.py [SCENE] [PLOT.png]: runs a scene and plots its forces and its nearest wall."""

import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import repel

scene = sys.argv[1] if len(sys.argv) > 1 else "anderson_4x8"
plot = sys.argv[2] if len(sys.argv) > 2 else "run.png"

with tempfile.TemporaryDirectory() as folder:
    log = Path(folder) / "run.mcap"
    report = repel.run(scene, seconds=5.0, log=log)
    run = repel.read_recording(log)

force = np.linalg.norm([run[f"virtual_f{axis}_n"] for axis in "xyz"], axis=0)
figure, (above, below) = plt.subplots(2, sharex=True, layout="constrained")
above.plot(run["time_s"], force)
above.set_ylabel("virtual force [N]")
below.plot(run["time_s"], 1e3 * run["nearest_m"])
below.set_ylabel("nearest pair [mm]")
below.set_xlabel("time [s]")
below.set_ylim(-5, 50)
figure.savefig(plot, dpi=100)
print(f"{report['ticks']} ticks, at most {force.max():.1f} N: {plot}")
