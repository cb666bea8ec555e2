#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/menagerie.py FOLDER [MODEL...]: a table in Markdown of which MJCF models are taken as arms.

FOLDER holds the MuJoCo menagerie, https://github.com/google-deepmind/mujoco_menagerie, or models
laid out as there, MODEL is one of its files, as franka_emika_panda/panda.xml. Without MODEL: all
but scenes and what floats. Needs the packages repel and mujoco. A model is read three times:

- by repel::load_mjcf_arm, as the program robot_info says, without a tip;
- by Arm.from_mujoco, to the body that carries all that moves last: the hand, or the last link;
- by repel.mujoco.attach, with its actuators disabled, which then runs for 100 ticks.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import warnings

import mujoco
import repel
import repel.mujoco


def tip_of(model):
    """The outermost body that carries all bodies of joints which carry no others."""
    def path(body):
        return {body} | (path(int(model.body_parentid[body])) if body else set())

    paths = [path(body) for body in range(model.nbody) if model.body_jntnum[body]]
    outer = [each for each in paths if not any(each < other for other in paths)]
    return model.body(max(set.intersection(*outer))).name


def in_cpp(robot_info, file):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder, "info.json")
        done = subprocess.run([robot_info, "--mjcf", file, "--json", report], text=True,
                              capture_output=True, check=False)
        if done.returncode:
            return done.stderr
        info = json.loads(report.read_text())
    return f"{info['dof']} joints, tool `{info['tool']['link']}`"


def in_python(model, tip):
    try:
        arm = repel.Arm.from_mujoco(model, tip)
    except ValueError as error:
        return str(error)
    return f"{len(arm.links)} joints, {len(arm.parts)} parts, tool `{tip}`"


def attached(model, tip):
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    try:
        sim = repel.mujoco.attach(model, data, site=tip)
    except ValueError as error:
        return str(error)
    for _ in range(100):
        tick = sim.step()
    ends = "runs" if tick.stop == "running" else tick.stop
    return ", ".join([ends, *tick.status])


def sentence(text, file):
    """On one line, without the name of the file."""
    return " ".join(text.replace("robot_info: ", "").replace(str(file), file.name).split())


def row(folder, file, robot_info):
    """None for what is no arm: a scene, keyframes, or a robot that floats."""
    try:
        model = mujoco.MjModel.from_xml_path(str(file))
    except ValueError as error:
        found = [sentence(str(error), file)] * 2
    else:
        if not model.njnt or mujoco.mjtJoint.mjJNT_FREE in map(int, model.jnt_type):
            return None
        tip = tip_of(model)
        found = [in_python(model, tip), attached(model, tip)]
        found[1] = "the same" if found[1] == found[0] else found[1]
    found.insert(0, in_cpp(robot_info, file))
    return f"| {file.relative_to(folder)} | {' | '.join(sentence(each, file) for each in found)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("model", nargs="*")
    parser.add_argument("--robot-info", default="build/release/bin/robot_info",
                        help="the program; default: %(default)s")
    arguments = parser.parse_args()
    folder = arguments.folder
    files = [folder / each for each in arguments.model] or sorted(
        each for each in folder.glob("*/*.xml") if not each.name.startswith(("scene", "keyframe")))
    warnings.simplefilter("ignore")  # of geoms that move without the arm
    print("| model | `load_mjcf_arm` | `Arm.from_mujoco` | `attach` |\n|---|---|---|---|")
    for file in files:
        found = row(folder, file, arguments.robot_info)
        if found is not None:
            print(found, flush=True)


if __name__ == "__main__":
    main()
