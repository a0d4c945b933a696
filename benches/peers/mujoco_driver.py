"""The scenes of `compare.py` in MuJoCo: jobs on standard input, an answer each (the protocol: README.md).

MuJoCo knows rigid bodies and soft contacts. On the ground the block is one body over a plane; the beam is a chain of rigid links whose hinges
are springs, which is how its manual builds beams. The clock runs over one call of `mujoco.rollout`, which makes all steps in C: Python's part
of it is some 65 µs a run.

    setting       is
    integrator    RK4, implicitfast, implicit, Euler
    solver        Newton, CG, PGS
    cone          elliptic, pyramidal
    timeconst     of the contact's spring, in steps (MuJoCo wants at least 2, unless refsafe=0)
    dampratio     of the contact's spring
    impedance     dmin = dmax of solimp
    impratio      friction's impedance over the normal one's
    noslip        iterations against slip
    feet          box: the box' own corners, two deep; points: one at each lower corner
    refsafe       0: no lower bound on timeconst
"""

import json
import math
import sys
import time

import mujoco
import numpy
from mujoco import rollout

MOST = 51  # repetitions end here, however short a run is
WIDTH, HEIGHT, DEPTH, DENSITY, FRICTION = 0.03, 0.135, 0.03, 2700.0, 0.5
SPAN, THICKNESS, YOUNG = 0.36, 0.0015, 69e9
TILT = math.radians(5)
POINT = 1e-6  # m, the radius of a foot
UNSTABLE = [mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC]
DEFAULTS = {
    "integrator": "RK4",
    "solver": "Newton",
    "cone": "elliptic",
    "timeconst": "2",
    "dampratio": "1",
    "impedance": "0.99",
    "impratio": "10",
    "noslip": "0",
    "feet": "points",
    "refsafe": "1",
}


def block(corner, feet):
    """The block on its lower left corner, which is at (corner, 0), tilted by 5°. Its joints are x, z and the angle, from the origin."""
    mass = DENSITY * WIDTH * HEIGHT * DEPTH
    inertia = [mass * (a * a + b * b) / 12 for a, b in ((DEPTH, HEIGHT), (WIDTH, HEIGHT), (WIDTH, DEPTH))]
    if feet == "box":
        shapes = f'<geom type="box" size="{WIDTH / 2} {DEPTH / 2} {HEIGHT / 2}" contype="0" conaffinity="1"/>'
    else:
        shapes = "".join(
            f'<geom type="sphere" size="{POINT}" pos="{side * WIDTH / 2} 0 {-HEIGHT / 2 + POINT}" contype="0" conaffinity="1"/>'
            for side in (-1, 1)
        )
    x, y = -WIDTH / 2, -HEIGHT / 2
    start = [
        corner - (math.cos(TILT) * x - math.sin(TILT) * y),
        -(math.sin(TILT) * x + math.cos(TILT) * y),
        TILT,
    ]
    if feet != "box":  # a foot's lowest point is where the corner would be, not its middle
        start[1] += POINT * (1 - math.cos(TILT))
    body = (
        '<body><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 -1 0"/>'
        f'<inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia[0]} {inertia[1]} {inertia[2]}"/>{shapes}</body>'
    )
    return body, start


def chain(links):
    """Links of equal length, hinged with the bending stiffness of a piece as long; pinned at the left, on a roller at the right."""
    length = SPAN / links
    stiffness = YOUNG * DEPTH * THICKNESS**3 / 12 / length
    mass = DENSITY * DEPTH * THICKNESS * length
    inertia = mass * length**2 / 12
    text = ""
    for link in range(links):
        at = 0 if link == 0 else length
        spring = 0 if link == 0 else stiffness
        text += (
            f'<body name="link{link}" pos="{at} 0 0" gravcomp="1"><joint type="hinge" axis="0 -1 0" stiffness="{spring}"/>'
            f'<inertial pos="{length / 2} 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>'
            f'<geom type="box" size="{length / 2} 0.015 0.005" pos="{length / 2} 0 -0.005" contype="1" conaffinity="0"/>'
        )
    text += "</body>" * links
    roller = (
        f'<body name="roller" pos="{SPAN} 0 0" gravcomp="1"><joint type="slide" axis="1 0 0"/>'
        '<inertial pos="0 0 0" mass="1e-5" diaginertia="1e-9 1e-9 1e-9"/></body>'
    )
    tie = f'<equality><connect body1="link{links - 1}" body2="roller" anchor="{length} 0 0" solref="{{ties}}" solimp="0.9999 0.9999 0.001"/></equality>'
    return text + roller, tie


def model(scene, elements, step, settings):
    values = dict(DEFAULTS)
    for setting in settings:
        key, _, value = setting.partition("=")
        if key not in values:
            raise ValueError(f"no setting «{key}»")
        values[key] = value
    contact = f'solref="{float(values["timeconst"]) * step} {values["dampratio"]}" solimp="{values["impedance"]} {values["impedance"]} 0.001"'
    if scene == "ground":
        body, start = block(-WIDTH / 2, values["feet"])
        world, ties = '<geom type="plane" size="1 1 1" contype="1" conaffinity="0"/>' + body, ""
    elif scene == "beam":
        body, start = block(0.165, values["feet"])
        bodies, ties = chain(elements)
        world, ties = body + bodies, ties.format(ties=f"{2 * step} 1")
    else:
        raise ValueError(f"no scene «{scene}»; there are ground and beam")
    text = f"""<mujoco><compiler angle="radian"/>
<option timestep="{step}" integrator="{values["integrator"]}" solver="{values["solver"]}" cone="{values["cone"]}" impratio="{values["impratio"]}"
 noslip_iterations="{values["noslip"]}" tolerance="1e-12" gravity="0 0 -9.81"><flag refsafe="{"enable" if values["refsafe"] == "1" else "disable"}" autoreset="disable"/></option>
<default><geom friction="{FRICTION} 0.005 0.0001" {contact}/></default>
<worldbody>{world}</worldbody>{ties}</mujoco>"""
    return mujoco.MjModel.from_xml_string(text), start


def job(line):
    words = line.split()
    if len(words) < 6:
        raise ValueError("a job is: SCENE ELEMENTS STEP STEPS BUDGET FILE KEY=VALUE…")
    scene, elements, step, steps, budget, file = words[:6]
    step, steps, budget = float(step), int(steps), float(budget)
    what, start = model(scene, int(elements), step, words[6:])
    data = mujoco.MjData(what)
    data.qpos[:3] = start
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    initial = numpy.empty((1, mujoco.mj_stateSize(what, kind)))
    mujoco.mj_getState(what, data, initial[0], kind)
    states = numpy.zeros((1, steps, initial.shape[1]))
    sensors = numpy.zeros((1, steps, what.nsensordata))
    times = []
    while not times or (sum(times) < budget and len(times) < MOST):
        begin = time.process_time()
        rollout.rollout(what, data, initial, nstep=steps, state=states, sensordata=sensors)
        times.append(time.process_time() - begin)
        if any(data.warning[kind].number for kind in UNSTABLE):
            raise ArithmeticError("the motion went to infinity")
    track = numpy.vstack([initial[0, 1:4], states[0, :, 1:4]])
    track.astype("<f8").tofile(file)
    return times


def main():
    for line in sys.stdin:
        try:
            answer = {"cpu_s": job(line)}
        except Exception as error:  # noqa: BLE001 - the job failed, not the program
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
