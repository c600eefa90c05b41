"""Columns and contributions of effects along a motion."""

from __future__ import annotations

from functools import cached_property, partial

import numpy as np

from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm
from modelgen.effects import CATALOGUE, Definition, DescriptionEffect, InputEffect, described
from modelgen.evaluation import programs
from modelgen.evaluation.alone import Alone, Values, free_values
from modelgen.evaluation.cache import Recent
from modelgen.evaluation.changed_description import Changed, Changes, Variations
from modelgen.evaluation.delay import acting, added, undone
from modelgen.evaluation.inertia_floor import carried
from modelgen.evaluation.known_forces import KnownForces
from modelgen.evaluation.lever_ratio import gain, leverage, reread
from modelgen.evaluation.link_encoder import LinkSide, at_link, compliant, lagging, led_by, rigid
from modelgen.evaluation.motion import Motion, evaluated, given_for
from modelgen.evaluation.states import TOUCH, Series
from modelgen.evaluation.tilted_gravity import HiddenWeight
from modelgen.functions.objects import Function, Model
from modelgen.model.equations import Equations
from modelgen.numeric import Array

REMEMBERED = 40  # results that do not depend on an effect's own values


class Evaluator:
    """One arm and its effects to be. `arm`: as described, with the effects that it has already.

    Base parameters are those of `modelgen.functions.build_model` for the same arm. Effects are named as in
    the catalogue, joints by the number of their coordinate from 1, None for the whole arm.
    """

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        self.base = programs.grouping(arm)
        self._alone = Alone(arm)
        self._made: dict[object, NumpyFunction] = {}
        self._arms: dict[object, Equations] = {}
        self._columns: dict[Equations, tuple[NumpyFunction, list[tuple[str, int]]]] = {}
        self._series: dict[Equations, Series] = {}
        self._recent: Recent[Array] = Recent(REMEMBERED)

    @cached_property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.arm.coordinates)

    def needs_load(self, effect: str, joint: int | None, values: Values) -> bool:
        """Whether its columns depend on the arm's base parameters."""
        effects = self._alone(effect, joint, values).effects
        return any(e.depends_on(name) for e in effects for name in ("load", "carried"))

    def inputs(self, motion: Motion, parameters: Array) -> Array:
        """Inputs of the arm as described, (N, n), for its base parameters."""
        if led_by(self.arm, motion):
            return self._rigid.inputs(motion, parameters) + self.link_side.led(motion, parameters)
        return self._recent.along(
            "own", motion, parameters, lambda: self._along("own", self._own, motion, parameters)
        )

    @cached_property
    def _rigid(self) -> Evaluator:
        return Evaluator(rigid(self.arm))

    def regressor(self, model: Model, motion: Motion, parameters: Array) -> Array:
        """The regressor of the arm's own model (N, n, p); `parameters` where its columns depend on them."""
        function = self._function(model, "regressor")
        names = {a.name for a in function.function.arguments}
        loads = states = None
        if self._own.state_names() and names & {"load", "state"}:
            states = self._states(self._own, motion, (), parameters)
            if not parameters.any():  # links that weigh nothing swing on no spring: as if none bent
                bent = self._series[self._own]
                states = np.where(np.isfinite(states), states, 0.0)
                states[:, [*bent.lags, *bent.rates]] = 0.0
        if "load" in names:
            made = self._function(model, "load")
            loads = np.asarray(made(**given_for(made.function, motion, parameters, states=states)))
        given = given_for(function.function, motion, parameters, loads=loads, states=states)
        return evaluated(function, given, motion).reshape(len(motion.t), self.n, -1)

    def unseen(self, motion: Motion, columns: Array, parameters: Array) -> Array:
        """Inputs (N, n) that the regressor (N, n, p) leaves out: what the arm's own elastic joints and play
        add; zero for parameters that all are.
        """
        if not parameters.any() or not compliant(self.arm):
            return np.zeros(motion.q.shape)
        if led_by(self.arm, motion):
            return self.link_side.led(motion, parameters)
        return self.inputs(motion, parameters) - columns @ parameters

    def ideal(self, model: Model, motion: Motion, given: Array) -> Array:
        """Inputs of ideal drives with the efforts of the measured ones (N, n), less those of `known` forces:
        what the regressor times the base parameters is to be.
        """
        given = acting(self.arm, motion.t, given)
        if any(f.name == "effective_input" for f in model.functions):
            function = self._function(model, "effective_input")
            known = {"input": given, "state": undone(self._own.effects, self.arm, model.states, given)}
            given = np.asarray(function(**{a.name: known[a.name] for a in function.function.arguments}))
        return given - self.known.inputs(motion)

    def states(self, motion: Motion, parameters: Array) -> Array:
        """States of the arm's own effects at every sample (N, s), from zero at the first."""
        found = self._states(self._own, motion, (), parameters)
        return lagging(found, self._own, motion, self.link_side.at_drives(motion, parameters))

    @cached_property
    def known(self) -> KnownForces:
        """What has no column in the regressor."""
        return KnownForces(self.arm)

    @cached_property
    def link_side(self) -> LinkSide:
        """Drives whose links' positions were measured."""
        return LinkSide(
            self._own, self.base, self._links, partial(gain, self.arm), partial(leverage, self.arm)
        )

    @cached_property
    def _own(self) -> Equations:
        """Equations of the arm with its own effects."""
        return Equations(slid(described(self.arm)), lazy=True)

    def _function(self, model: Model, name: str) -> NumpyFunction:
        if ("model", name) not in self._made:
            function = model.function(name)
            self._made["model", name] = NumpyFunction(function)
        return self._made["model", name]

    def columns(
        self, effect: str, joint: int | None, motion: Motion, values: Values, parameters: Array
    ) -> Array:
        """Inputs per unit of each linear parameter, (N, n, k), for `values` of the others.

        States start at zero and are stepped along the motion. Raises InputError where the effect cannot
        stand there.
        """
        e = self._alone(effect, joint, values)
        names = [p.name for p in CATALOGUE[effect].linear]
        if e not in self._columns:
            function, places = programs.columns_of(e)
            self._columns[e] = NumpyFunction(function), places
        call, places = self._columns[e]
        found = self._run(call, e, call.function, motion, values, parameters)
        result = np.zeros((len(motion.t), self.n, len(names)))
        for k, (name, coordinate) in enumerate(places):
            result[:, coordinate, names.index(name)] += found[:, k]
        return result

    def contribution(
        self, effect: str, joint: int | None, motion: Motion, values: Values, parameters: Array
    ) -> Array:
        """Inputs that an effect with these values of all its parameters adds, (N, n)."""
        definition = CATALOGUE[effect]
        delay, factor = definition.delays(values), definition.scales(values)
        if delay is not None:
            return added(motion.t, self.inputs(motion, parameters), delay, joint, definition.lags(values))
        if factor is not None and joint is not None and self._proportional:
            self._changed(effect, joint, values)  # where the arm admits it
            inputs = self.inputs(motion, parameters)
            return np.asarray(inputs * (factor - 1) * (np.arange(self.n) == joint - 1))
        if issubclass(definition, DescriptionEffect | InputEffect):
            return self._by_change(definition, joint, motion, values, parameters)
        if definition.linear:
            weights = np.array([values.get(p.name, 0.0) for p in definition.linear])
            columns = self.columns(effect, joint, motion, values, parameters)
            return np.asarray(columns @ weights)
        if joint is not None and at_link(motion, joint):
            return self.link_side.added(joint, motion, dict(values), parameters)
        e = self._alone(effect, joint, values)
        call = self._with_links(e)
        if joint is not None:
            parameters = self._carried(joint, motion, parameters)
        found = self._run(call, e, call.function, motion, values, parameters)
        return found - self._links(motion, programs.links_alone(self.arm, self.base, joint, parameters))

    def _with_links(self, e: Equations) -> NumpyFunction:
        if (e, "added") not in self._made:
            self._made[e, "added"] = NumpyFunction(programs.links_and_effect(e, self.base))
        return self._made[e, "added"]

    def ringing(self, effect: str, joint: int, motion: Motion, values: Values, parameters: Array) -> Array:
        """Inputs (N, n, 2) by which an elastic joint at a measured motor rings in `Motion.beginning`: per
        unit of a further lag of its link at the begin, and of a rate of that.
        """
        e, part = self._alone(effect, joint, values), motion.beginning
        call, parameters = self._with_links(e), self._carried(joint, motion, parameters)

        def added(push: Array) -> Array:
            return self._run(call, e, call.function, part, values, parameters, push)

        still, found = added(np.zeros(len(e.state_names()))), np.zeros((*motion.q.shape, 2))
        places = [self._series[e].lags[0], self._series[e].rates[0]]
        pushes = TOUCH * np.eye(len(e.state_names()))[places]
        found[: len(part.t)] = np.stack([(added(push) - still) / TOUCH for push in pushes], axis=2)
        return found

    def _by_change(
        self,
        definition: type[Definition],
        joint: int | None,
        motion: Motion,
        values: Values,
        parameters: Array,
    ) -> Array:
        """Inputs (N, n) of the arm with the effect, less those of the arm without."""
        changed = self._changed(definition.name, joint, values)
        read = joint is not None and motion.motor_side and motion.motor_side[joint - 1]
        if definition.rereads and joint is not None and read:
            seen = reread(motion, described(self.arm), changed.arm, joint)
            return self._inputs_of(changed, seen, parameters) - self.inputs(motion, parameters)
        found = self._inputs_of(changed, motion, parameters) - self.inputs(motion, parameters)
        turned = np.subtract(changed.arm.gravity, self._own.arm.gravity)
        return found + self.hidden_weight.inputs(motion, turned) if turned.any() else found

    def _carried(self, joint: int, motion: Motion, parameters: Array) -> Array:
        """Parameters with which what the joint carries can be simulated."""
        alone = programs.links_alone(self.arm, self.base, joint, parameters)
        given = self.arm, self.base, joint, motion, alone, self._bare, self.link_side.drives
        return self._recent.along(
            ("carried", joint), motion, parameters, lambda: parameters + (carried(*given) - alone)
        )

    def _links(self, motion: Motion, parameters: Array) -> Array:
        """Inputs of the links alone."""
        return self._recent.along("links", motion, parameters, lambda: self._bare(motion, parameters))

    @cached_property
    def _bare(self) -> programs.Links:
        return programs.Links(self.arm, self.base)

    @cached_property
    def _proportional(self) -> bool:
        """Whether all inputs are efforts over torque constants: no drive bends them."""
        return not any(part.place == "input" for effect in self._own.effects for part in effect.parts)

    @cached_property
    def hidden_weight(self) -> HiddenWeight:
        """What weighs in a gravity of another direction and the base parameters do not contain."""
        return HiddenWeight(self.arm, self.base)

    @cached_property
    def _varied(self) -> Variations:
        return Variations(described(self.arm), self.base)

    @cached_property
    def _changed(self) -> Changes:
        """The arm with an effect on its description besides."""
        return Changes(self.arm, None if self._own.state_names() else self._varied)

    def _inputs_of(self, changed: Changed, motion: Motion, parameters: Array) -> Array:
        if changed.geometry is not None:
            call = self._varied.call
            given = given_for(call.function, motion, parameters, geometry=changed.geometry)
            return evaluated(call, given, motion)
        if changed.key not in self._arms:
            self._arms[changed.key] = Equations(slid(changed.arm), lazy=True)
        return self._along(changed.key, self._arms[changed.key], motion, parameters)

    def _along(self, key: object, e: Equations, motion: Motion, parameters: Array) -> Array:
        """Inputs of an arm whose own effects may have states."""
        if ("inputs", key) not in self._made:
            self._made["inputs", key] = NumpyFunction(programs.inputs_of(e, self.base))
        call = self._made["inputs", key]
        return evaluated(call, self._given(call.function, e, motion, parameters), motion)

    def _loads(self, motion: Motion, parameters: Array) -> Array:
        """Loads at the motor coordinates (N, n) of the arm with its own effects."""
        if "loads" not in self._made:
            self._made["loads"] = NumpyFunction(programs.loads_of(self._own, self.base))
        call = self._made["loads"]
        return np.asarray(call(**self._given(call.function, self._own, motion, parameters)))

    def _given(self, f: Function, e: Equations, motion: Motion, parameters: Array) -> dict[str, Array]:
        """Arguments of a function of an arm, with the states of its effects, (N, .) or (.,) by name."""
        states = self._states(e, motion, (), parameters) if e.state_names() else None
        return given_for(f, motion, parameters, states=states)

    def _run(
        self,
        call: NumpyFunction,
        e: Equations,
        function: Function,
        motion: Motion,
        values: Values,
        parameters: Array,
        push: Array | None = None,
    ) -> Array:
        free = free_values(e, values)
        loads = None
        if any(effect.depends_on("load") for effect in e.effects):
            loads = self._recent.along("loads", motion, parameters, partial(self._loads, motion, parameters))
        states = self._states(e, motion, free, parameters, push) if e.state_names() else None
        given = given_for(function, motion, parameters, free=free, loads=loads, states=states)
        return evaluated(call, given, motion)

    def _states(
        self,
        e: Equations,
        motion: Motion,
        free: tuple[float, ...],
        parameters: Array,
        push: Array | None = None,
    ) -> Array:
        """States at every sample, (N, s), from zero or where the motion before left them; a transmission's
        from where its load holds it, and its push (s,) beside.
        """
        if e not in self._series:
            self._series[e] = Series(e, self.base, REMEMBERED)
        found = self._series[e].run(motion, free, parameters, push)[:-1]
        return lagging(found, e, motion, motion)  # a measured link is where it is
