// SPDX-License-Identifier: BSD-3-Clause
// The modules of the network, named in words, each with a sentence of what it does. By the word
// that a scene file has for the kind; docs/network has a page of each.

const MODULES = {
  torque_arm: ["lever of the hand",
    "A simulated lever with inertia and friction; a hand moves it, and feels its torque."],
  multiplex: ["lever to tool",
    "Turns the motion of the lever into one of the tool along a direction, and its force back."],
  spaceball: ["six-axis mouse",
    "Adds the rates that a mouse, a gamepad or the keys ask for. It gives no force back."],
  six_axes: ["six-axis master",
    "A simulated handle that a hand moves in all directions, and that pushes the hand back."],
  relief: ["give in chosen directions",
    "Springs and dampers along the directions that are to give way; the others stay rigid."],
  kbb2: ["coupling",
    "A spring and a damper between operator and tool: smooths what is commanded, limits the force."],
  guide: ["virtual fixtures",
    "Draws the tool to points, lines, planes and paths, with a force that a hand can overcome."],
  obstacle: ["walls on the tool",
    "The virtual forces of all that is near the tool, as one force and one torque on it."],
  arm_obstacle: ["walls on the links",
    "The virtual forces of all that is near the links of the arm, as torques of its joints."],
  puma_kin: ["kinematics",
    "From joint rates to the motion of the tool, and from its force to torques. Loses nothing."],
  limits: ["joint limits",
    "A spring and a damper over the last piece before the end of the range of a joint."],
  posture: ["posture",
    "Springs and dampers that bring the elbow back to where it was, while the tool stays."],
  force_sensor: ["force sensor",
    "Adds torques for a measured contact, so that it is felt and not what the arm adds to it."],
  visual: ["display",
    "Marks a place in the network, and passes everything on as it is."],
  puma_joints: ["joints of the robot",
    "The robot: how fast its joints turn comes in, and the torques for its drives go out."],
  ground: ["ground", "Stands still, whatever pushes it."],
  line: ["line with delay",
    "Joins two sides over a channel that delays, mixes up and loses what is sent, and adds no " +
    "energy."],
  junction: ["junction", "Joins branches that share a motion, or that share a force."],
  spring: ["spring", "Stores what bends it, and gives it back."],
  damper: ["damper", "Resists motion the more the faster it is, and turns energy into heat."],
  mass: ["mass", "Resists a change of its motion, and stores energy in it."],
};

export const kinds = () => Object.keys(MODULES);

// { name, what } of a module by the name that it has in the scene: that of its kind, or another
// that the scene gave it.
export function moduleWords(name) {
  const [words, what] = MODULES[name] ?? [name.replaceAll("_", " "), "Named so by the scene."];
  return { name: words, what };
}
