"""What docs/strangers.md says in words; {names} are figures that blind.page counts from the kept answers."""

from __future__ import annotations

INTRODUCTION = """\
# Strangers' arms: measured

*How often does `modelgen diagnose` name what is there, and what is not, on arms and records that it was not
made for?*

- **Nothing hidden:** it names something in {alarms}.
- **One effect of [the catalogue](effects.md) hidden, with two thirds of the noise's power (s = {s}):** it
  names this effect, at its joint, and nothing else in {named}, and something false in {misnamed}.
- **A cause of that size hidden that the catalogue lacks:** it names something all the same in {outside}.

In brackets: 95 % Wilson intervals.

## What the words mean

- **Hidden** is what a simulated arm has and its description lacks: `nothing`; `one effect` of the
  catalogue; `lost motion`, which is play, an elastic joint or presliding; or `outside`, a law that the
  catalogue lacks.
- **s** is the size of what is hidden: the error (RMSE) that a fit of the described model leaves, over the
  error of the same fit where it is not there. At s = 1.10 the hidden thing has a fifth of the noise's
  power, at 1.30 two thirds.
- **Exact** is the right name at the right joint and nothing else; for `nothing` and `outside`, no name at
  all. The answers without a name are "nothing is missing", "something outside the catalogue", "I cannot
  tell", and a suspect with the check that it failed.
- **A false name** counts the arms on which something is named that is not there. Another cause of lost
  motion at the right joint is neither exact nor false.
- **Families** are two makers of arms. B is Lagrange's equations in C, with joint loops, sticking friction,
  inductances, and logs that read their channels late. C is random arms simulated by MuJoCo. They share no
  code with modelgen, nor with each other.
- **Records** are the logs of an arm: `two` of 30 s at 100 Hz, `four` of 30 s at 500 Hz, both periodic, or
  `ordinary`: pick and place, jogging and sweeps, in which nothing repeats.

## The answers
"""
BY_RECORDS = "By family and records"
CANNOT = """\
## What it cannot do yet

- **Tell the causes of lost motion apart.** At s = {s} it names the right one in {lost}; another one at the
  right joint in {siblings} more. Read the name of such a cause as lost motion at that joint, and look at
  its rivals in the report.
- **See that a cause is not in the catalogue**, if a law in the catalogue acts nearly alike on these
  records. Where what is left is as large as the noise, no record tells the two apart. Before you rely on a
  name, look at its rivals in the report, and add a log of another motion as a further `--train`.
- **Name everything small.** At s = {small} it names the hidden effect, and nothing else, in {named_small},
  and something false in {misnamed_small}.
"""
OTHERS = """\
## What others name

The same records, and other ways to choose. All get the same filtered equations, those of the band that
modelgen asks first, and the same columns: every candidate of [the catalogue](effects.md) at every place,
with the values at which it explains most alone beside the user's model. modelgen's search finds these, so
that the others need none. What is compared is the choice, not the filtering. The parameters of the user's
model are fitted beside whatever is chosen. None of the others has modelgen's checks. The judge is the same,
and aliases count for all.

![Exact names, false names and error removed, by method](strangers.svg)

Error removed is on the test record, which no method has seen: of the mean square error that the hidden
effect adds to the noise, at its joint, the part that the extended model removes; all cases together, with
an interval of 95 % by a bootstrap of the cases. A method that names nothing removes nothing. A near
relative of what is hidden, or several of them together, can predict as well as the right name: an error
removed is no proof of a name. The network names nothing; it learns what the user's model leaves.
"""
COUNTED = """\
Counted on {common} of the {every} cases: those that all have answered, and in which the user's model leaves
the same error in the band of either.
"""
CHECKS = """\
## What each check is worth

All answers, counted again as if a check decided otherwise: without one that decides, what it alone
made a suspect is named. The checks are described in [how a diagnosis works](diagnosis_method.md).
"""
SETS = """\
## All sets

Each set was answered once, by the code of the commit that its name ends with; that commit's hash is its
seed, so that nobody can have chosen it. A set measures the code of its own commit alone. The answers above
are those of the newest set of {few} cases or more of each family, kind of records, what is hidden, and
size. Every answer is kept in `benchmarks/blind/runs`.
"""
EVERY_SET = "Every set, the oldest first"
RUNNING = """\
## Run it, add a method

From `benchmarks`, a set is made and answered, then counted; `benchmarks/blind/README.md` has the options.
`--set HASH` has the seeds of a commit.

```sh
python -m blind.runner DIR --family b --kinds nothing one outside --settings two
python -m blind.judge DIR --wrong
```

A method of your own is a class of a few lines in a module of `benchmarks/blind/others/methods`; it is found
by the module's name. The same README shows one.

```sh
pip install -e "..[others]"
python -m blind.others.runner mine --seconds 600   # goes on where it ended
python -m blind.page                               # this page with its row
```
"""
