"""The plant's equations once more, over samples: energies, inverse dynamics and its regressor."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from blind.case import Array

if TYPE_CHECKING:
    from blind.family_b.world import Body


def lumped(body: Body, which: str) -> dict[str, float]:
    """Numbers of plant.c for a link. which: "2" upper, "3" fore."""
    m, x, y = body.mass, body.x, body.y
    return {
        f"m{which}": m,
        f"s{which}x": m * x,
        f"s{which}y": m * y,
        f"zz{which}": body.turn + m * (x * x + y * y),
        f"xx{which}": body.along + m * y * y,
        f"yy{which}": body.across + m * x * x,
        f"xy{which}": -m * x * y,
        f"w{which}": m,
        f"w{which}x": m * x,
        f"w{which}y": m * y,
    }


def carrying(arm: dict[str, float], payload: tuple[float, float, float]) -> dict[str, float]:
    """The arm with a point mass at x, y of the fore link."""
    m, x, y = payload
    more = {
        "m3": m, "s3x": m * x, "s3y": m * y, "zz3": m * (x * x + y * y), "xx3": m * y * y, "yy3": m * x * x,
        "xy3": -m * x * y, "w3": m, "w3x": m * x, "w3y": m * y,
    }  # fmt: skip
    return {**arm, **{k: arm[k] + v for k, v in more.items()}}


def motor(joint: dict[str, float], q: Array) -> tuple[Array, Array, Array]:
    """Motor angle and its first and second derivative by the joint's."""
    if not joint.get("levered"):
        one = np.ones_like(q)
        return joint["ratio"] * q, joint["ratio"] * one, 0 * one
    u, p = joint["rev"] * (q - joint["angle"]), joint["l1"] * joint["l2"]
    x = np.sqrt(joint["l1"] ** 2 + joint["l2"] ** 2 - 2 * p * np.cos(u))
    first = p * np.sin(u) / x
    second = p * np.cos(u) / x - first**2 / x
    return (
        (x - joint["length0"]) / joint["per_rad"],
        joint["rev"] * first / joint["per_rad"],
        second / joint["per_rad"],
    )


def efforts(arm: Mapping[str, float | Array], q: Array, v: Array, a: Array) -> Array:
    """Joint efforts (N, 3) of the links: Lagrange in absolute angles.

    q, v, a: (N, 3) angles of column, shoulder, elbow and their rates. Linear in the masses and moments of
    `arm`, of which each may be a column (k, 1): the efforts are then (k, N, 3).
    """
    p = {name: arm.get(name, 0.0) for name in (*LINKS, "column", "offset", "length", "gx", "gy", "gz")}
    e, length = p["offset"], p["length"]
    f2, f3, d2, d3, dp = q[:, 1], q[:, 1] + q[:, 2], v[:, 1], v[:, 1] + v[:, 2], v[:, 0]
    e2, e3, ep = a[:, 1], a[:, 1] + a[:, 2], a[:, 0]
    c2, s2, c3, s3, cd, sd = np.cos(f2), np.sin(f2), np.cos(f3), np.sin(f3), np.cos(f3 - f2), np.sin(f3 - f2)
    c = length * (p["s3x"] * cd - p["s3y"] * sd)
    dc = length * (-p["s3x"] * sd - p["s3y"] * cd)
    x2, z2 = p["s2x"] * c2 - p["s2y"] * s2, p["s2x"] * s2 + p["s2y"] * c2
    x3, z3 = p["s3x"] * c3 - p["s3y"] * s3, p["s3x"] * s3 + p["s3y"] * c3
    out = e + length * c2
    h = (
        p["column"]
        + p["xx2"] * s2**2
        + p["yy2"] * c2**2
        + 2 * p["xy2"] * s2 * c2
        + p["m2"] * e**2
        + 2 * e * x2
    )
    h = h + p["xx3"] * s3**2 + p["yy3"] * c3**2 + 2 * p["xy3"] * s3 * c3 + p["m3"] * out**2 + 2 * out * x3
    h2 = 2 * (p["xx2"] - p["yy2"]) * s2 * c2 + 2 * p["xy2"] * (c2**2 - s2**2) - 2 * e * z2
    h2 = h2 - 2 * length * s2 * (p["m3"] * out + x3)
    h3 = 2 * (p["xx3"] - p["yy3"]) * s3 * c3 + 2 * p["xy3"] * (c3**2 - s3**2) - 2 * out * z3
    gr = p["gx"] * np.cos(q[:, 0]) + p["gy"] * np.sin(q[:, 0])
    gn = -p["gx"] * np.sin(q[:, 0]) + p["gy"] * np.cos(q[:, 0])
    wx2, wz2 = p["w2x"] * c2 - p["w2y"] * s2, p["w2x"] * s2 + p["w2y"] * c2
    wx3, wz3 = p["w3x"] * c3 - p["w3y"] * s3, p["w3x"] * s3 + p["w3y"] * c3
    u2 = gr * (wz2 + p["w3"] * length * s2) - p["gz"] * (wx2 + p["w3"] * length * c2)
    u3 = gr * wz3 - p["gz"] * wx3
    t1 = h * ep + (h2 * d2 + h3 * d3) * dp - gn * (p["w2"] * e + wx2 + p["w3"] * out + wx3)
    t2 = (p["zz2"] + p["m3"] * length**2) * e2 + c * e3 + dc * d3**2 - 0.5 * h2 * dp**2 + u2
    t3 = p["zz3"] * e3 + c * e2 - dc * d2**2 - 0.5 * h3 * dp**2 + u3
    return np.stack([t1, t2 + t3, t3], axis=-1)


LINKS = tuple(n + k for k in "23" for n in ("m", "zz", "xx", "yy", "xy", "w")) + tuple(
    f"{n}{k}{side}" for k in "23" for n in "sw" for side in "xy"
)


def regressor(arm: dict[str, float], q: Array, v: Array, a: Array) -> Array:
    """Columns (k, N, 3) of the links' masses and moments, weights among them. Not all are independent."""
    units: list[tuple[str, ...]] = [("column",)]
    for k in "23":
        units += [(f"m{k}", f"w{k}"), (f"s{k}x", f"w{k}x"), (f"s{k}y", f"w{k}y")]
        units += [(f"{n}{k}",) for n in ("zz", "xx", "yy", "xy")]
    one = np.eye(len(units))[:, :, None]
    columns = {name: one[k] for k, names in enumerate(units) for name in names}
    return efforts({**arm, **columns}, q, v, a)


def still(arm: dict[str, float], centre: Array, reach: Array) -> tuple[Array, Array]:
    """Inertia of each axis in mid-range, and the largest weight that it bears anywhere [kg m^2, N m]."""
    nothing = np.zeros((1, 3))
    middle = centre[None]
    weight = efforts(arm, middle, nothing, nothing)
    inertia = np.array([(efforts(arm, middle, nothing, np.eye(3)[k][None]) - weight)[0, k] for k in range(3)])
    q = centre + reach * np.stack(np.meshgrid(*[[-1, 0, 1]] * 3), axis=-1).reshape(-1, 3)
    heaviest = np.abs(efforts(arm, q, np.zeros_like(q), np.zeros_like(q))).max(axis=0)
    return inertia, heaviest


def joint_angle(joint: dict[str, float], m: Array) -> Array:
    """Joint angle at a motor angle."""
    if not joint.get("levered"):
        return m / joint["ratio"]
    x = joint["length0"] + joint["per_rad"] * m
    cosine = (joint["l1"] ** 2 + joint["l2"] ** 2 - x * x) / (2 * joint["l1"] * joint["l2"])
    return joint["rev"] * np.arccos(np.clip(cosine, -1, 1)) + joint["angle"]
