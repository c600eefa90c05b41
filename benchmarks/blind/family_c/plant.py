"""The arm in MuJoCo, and its run by steps.c."""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import mujoco
import numpy as np

from blind.case import Array
from blind.family_c.arms import ARM_NUMBERS, JOINT_NUMBERS, Lever, Link, World

SOURCE = Path(__file__).with_name("steps.c")
STEP = 5e-4  # s
PER_TICK = 2  # steps of a tick of the loops: 1 kHz
TICK = STEP * PER_TICK
STICK = (2 * STEP, 1.0)  # the quickest that MuJoCo allows: a joint that sticks stops within a step
HARD = (0.9999, 0.9999, 1e-3, 0.5, 2.0)
FLAGS = ("-O2", "-ffp-contract=off", "-shared", "-fPIC")


class Unstable(Exception):
    """The motion ran away."""


def frame(link: Link) -> tuple[Array, Array]:
    """Place (3) and rotation (3, 3) of a link in the frame before it, at the coordinate 0."""
    ca, sa, ct, st = np.cos(link.alpha), np.sin(link.alpha), np.cos(link.theta), np.sin(link.theta)
    turn = np.array([[1, 0, 0], [0, ca, -sa], [0, sa, ca]]) @ np.array([[ct, -st, 0], [st, ct, 0], [0, 0, 1]])
    return np.array([link.d, -link.r * sa, link.r * ca]), turn


def build(world: World, *, carrying: bool = False) -> mujoco.MjModel:
    """Model of the arm. carrying: with its payload.

    Bodies 1 to n are the links; a rotor of its own, where there is one, comes after them. Tendon and actuator
    k belong to drive k.
    """
    spec = mujoco.MjSpec()
    spec.option.timestep = STEP
    spec.option.gravity = world.gravity
    spec.option.tolerance = 1e-10
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_ISLAND | mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    antecedent = spec.worldbody
    for k, link in enumerate(world.links):
        place, turn = frame(link)
        body = antecedent.add_body(name=f"link{k}", pos=place, quat=_quaternion(turn))
        kind = mujoco.mjtJoint.mjJNT_SLIDE if link.slides else mujoco.mjtJoint.mjJNT_HINGE
        body.add_joint(name=f"q{k}", type=kind, axis=[0, 0, 1], limited=mujoco.mjtLimited.mjLIMITED_FALSE)
        _fill(body, link.mass, np.array(link.com), np.array(link.inertia))
        lever = world.levers[k]
        if lever is not None:
            _attach(antecedent, body, k, place, turn, lever)
        antecedent = body
    if carrying and world.payload is not None:
        mass, *at = world.payload
        load = antecedent.add_body(name="payload", pos=at)
        _fill(load, mass, np.zeros(3), 1e-9 * np.eye(3))
    if world.elastic is not None:
        slides = world.links[world.elastic].slides
        rotor = spec.worldbody.add_body(name="rotor")
        kind = mujoco.mjtJoint.mjJNT_SLIDE if slides else mujoco.mjtJoint.mjJNT_HINGE
        rotor.add_joint(name="rotor", type=kind, axis=[1, 0, 0])
        rotor.gravcomp = 1
        _fill(rotor, 1e-7, np.zeros(3), 1e-7 * np.eye(3))
    for k in range(world.count):
        _drive(spec, world, k)
    if world.coupling is not None:
        part = world.coupling
        tendon = spec.add_tendon(name="coupling", armature=part.inertia, damping=[part.viscous, 0, 0])
        tendon.wrap_joint(f"q{part.one}", 1.0)
        tendon.wrap_joint(f"q{part.other}", part.ratio)
        _dry(tendon, part.dry)
    return spec.compile()


def _fill(body: mujoco.MjsBody, mass: float, com: Array, inertia: Array) -> None:
    body.explicitinertial = True
    body.mass, body.ipos = mass, com
    i = inertia
    body.fullinertia = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]


def _attach(
    antecedent: mujoco.MjsBody, body: mujoco.MjsBody, k: int, place: Array, turn: Array, lever: Lever
) -> None:
    """Ends of an actuator: on the antecedent, in the link's plane at the coordinate 0, and on the link."""
    fixed = np.array([np.cos(lever.angle), np.sin(lever.angle), 0.0]) * lever.l1
    antecedent.add_site(name=f"base{k}", pos=place + turn @ fixed)
    body.add_site(name=f"crank{k}", pos=[lever.l2, 0, 0])


def _drive(spec: mujoco.MjSpec, world: World, k: int) -> None:
    own = world.numbers[k]
    tendon = spec.add_tendon(name=f"drive{k}", armature=world.rotors[k] * own["scale"] ** 2)
    if world.levers[k] is not None:
        tendon.wrap_site(f"base{k}")
        tendon.wrap_site(f"crank{k}")
    else:
        tendon.wrap_joint("rotor" if k == world.elastic else f"q{k}", 1.0)
    _dry(tendon, 1.0)  # steps.c sets the level
    spec.add_actuator(name=f"drive{k}", target=f"drive{k}", trntype=mujoco.mjtTrn.mjTRN_TENDON)


def _dry(tendon: mujoco.MjsTendon, level: float) -> None:
    tendon.frictionloss, tendon.solref_friction, tendon.solimp_friction = level, STICK, HARD


def _quaternion(turn: Array) -> Array:
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, turn.ravel())
    return out


@cache
def library() -> ctypes.CDLL:
    """The compiled steps, kept in a folder of this user beside other temporary files."""
    compiler = os.environ.get("CC") or shutil.which("cc")
    if compiler is None:
        raise RuntimeError("family C needs a C compiler: none is called cc, and CC is not set")
    package = Path(mujoco.__file__).parent
    engine = next(iter(sorted(package.glob("libmujoco.*"))))
    names = [f"-DARM_NUMBERS={','.join(ARM_NUMBERS)}", f"-DJOINT_NUMBERS={','.join(JOINT_NUMBERS)}"]
    line = [compiler, *FLAGS, *names, "-I", str(package / "include"), "-x", "c", str(SOURCE), "-x", "none"]
    line += [str(engine), f"-Wl,-rpath,{package}", "-lm"]
    key = hashlib.sha256(SOURCE.read_bytes() + "\0".join([*line, mujoco.__version__]).encode()).hexdigest()[
        :16
    ]
    folder = Path(tempfile.gettempdir()) / f"blind-family-c-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    if folder.stat().st_uid != os.getuid():
        raise RuntimeError(f"{folder} belongs to another user")
    target = folder / f"steps-{key}.so"
    if not target.exists():
        fresh = folder / f"steps-{key}-{os.getpid()}.so"
        subprocess.run([*line, "-o", str(fresh)], check=True)
        fresh.replace(target)
    loaded = ctypes.CDLL(str(target))
    if (loaded.plant_sizes(0), loaded.plant_sizes(1)) != (len(ARM_NUMBERS), len(JOINT_NUMBERS)):
        raise RuntimeError("the numbers of steps.c were not read right")
    return loaded


def packed(names: tuple[str, ...], values: dict[str, float]) -> Array:
    """Numbers in the order of `names`, zero where none is given. Raises KeyError for other names."""
    unknown = sorted(set(values) - set(names))
    if unknown:
        raise KeyError(f"steps.c has no {', '.join(unknown)}")
    return np.array([values.get(name, 0.0) for name in names])


def run(
    world: World,
    reference: Array,
    *,
    start: Array,
    speed: Array | None = None,
    begin: int = 0,
    push: Array | None = None,
    gain: Array | None = None,
    carrying: bool = False,
) -> Array:
    """Motion under the loops: joints, motors, currents of every step (ticks * PER_TICK, 3 n).

    reference: (ticks, n) angles of the motors [rad]; start, speed: joint coordinates and rates (n) at the
    beginning; begin: tick from which the drives warm up; push: (ticks, n) joint efforts from outside; gain:
    (ticks, n) factors of the torque constants. Raises Unstable.
    """
    n, ticks = world.count, len(reference)
    rates = np.gradient(reference, TICK, axis=0)
    followed = np.ascontiguousarray(np.stack([reference, rates, np.gradient(rates, TICK, axis=0)], axis=2))
    push = np.zeros((ticks, n)) if push is None else np.ascontiguousarray(push, float)
    gain = np.ones((ticks, n)) if gain is None else np.ascontiguousarray(gain, float)
    if push.shape != (ticks, n) or gain.shape != (ticks, n) or start.shape != (n,):
        raise ValueError("start, push or gain is of the wrong shape")
    model = build(world, carrying=carrying)
    data = mujoco.MjData(model)
    data.qpos[:n] = start
    data.qvel[:n] = 0.0 if speed is None else speed
    if world.elastic is not None:
        data.qpos[n], data.qvel[n] = start[world.elastic], data.qvel[world.elastic]
    arm = packed(ARM_NUMBERS, dict(world.space))
    joints = np.stack([packed(JOINT_NUMBERS, {"lag": 1e-3, "grain": 1e-9, **own}) for own in world.numbers])
    log = np.empty((ticks * PER_TICK, 3 * n))

    def at(x: Array) -> ctypes.c_void_p:
        return ctypes.c_void_p(x.ctypes.data)

    failed = library().plant_run(
        ctypes.c_void_p(model._address), ctypes.c_void_p(data._address), at(arm), at(joints), ctypes.c_int(n),
        ctypes.c_int(-1 if world.elastic is None else world.elastic), ctypes.c_long(ticks),
        ctypes.c_int(PER_TICK), ctypes.c_long(begin), at(followed), at(push), at(gain), at(log),
    )  # fmt: skip
    if failed:
        raise Unstable("the motion ran away")
    return log
