"""Types of the JSON reports, for editors and type checkers: what `Report.to_dict()` returns.

Made from the JSON schema of reports by site/python_types.py; do not edit. Lengths are in D and angles in radians.
"""

from __future__ import annotations

import sys
from typing import Any, Literal, TypedDict

if sys.version_info >= (3, 11):
    from typing import NotRequired
else:
    from typing import Optional as NotRequired


class Docked(TypedDict):
    """What counts as docked. What it means for a pair of halves is `crate::contact::Seat`'s."""

    #: How far above the mated height a half may lie and be seated, in D.
    depth: float
    #: The largest error at rest that counts, in the order of `Dof::ALL`: D and radians; none: whatever the seat allows.
    limits: list[float | None]


class Alignment(TypedDict):
    """The alignment problem of a pair of halves. Stored with every result."""

    #: Errors that occur, and that contact may correct. The others are locked: rotations at 0, translations at the COR.
    free: list[Literal['x', 'y', 'roll', 'pitch', 'yaw']]
    #: Rotations that do not matter (yaw of a round plug): locked in the motion, ignored in the verdict.
    dont_care: list[Literal['x', 'y', 'roll', 'pitch', 'yaw']]
    #: Signed distance of the COR in front of the face centre, in D.
    center_of_rotation: float
    #: ρ: overdamped motion dissipates `\|v\|² + (ρD)²·\|ω\|²`, v at the COR. In D.
    rotation_length: float
    #: The half turn that mounts the moving half.
    mount: Literal['x', 'y']
    #: n-fold symmetry about the approach axis: turned by 2π/n the pair is aligned as well.
    symmetry: int
    #: Half-ranges of the error box in the order of `Dof::ALL`: D and radians. Only free ones count.
    half_ranges: list[float]
    #: What counts as docked.
    docked: Docked


class Design(TypedDict):
    """A checked design: lengths in D, angles in radians."""

    #: What the person called it.
    name: str
    #: The two halves.
    connector: dict[str, Any]
    #: D in `unit`; 1 for a dimensionless design.
    width: float
    #: The unit of `width`; `None` for a dimensionless design.
    unit: Literal['um', 'mm', 'cm', 'm', 'in'] | None
    #: The alignment problem.
    alignment: Alignment


class AxisReport(TypedDict):
    """One axis of the error grid."""

    #: Which error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: `D` or `rad`.
    unit: Literal['D', 'rad']
    #: Lower border of the error box.
    lo: float
    #: Upper border of the error box.
    hi: float
    #: Number of equal cells, each sampled at its centre.
    cells: int


class Outcomes(TypedDict):
    """Poses per outcome."""

    #: Contact brings the halves to the mated pose.
    aligned: int
    #: At rest in contact elsewhere.
    jammed: int
    #: No contact, or slid off.
    missed: int
    #: The budget ran out.
    undecided: int


class Stratum(TypedDict):
    """What was seen in one stratum."""

    #: What it holds.
    name: str
    #: Its share of the error box, in [0, 1]; exact.
    share: float
    #: Poses followed in it.
    descents: int
    #: How many of them aligned.
    aligned: int
    #: How many could not be followed to their end.
    undecided: int
    #: Estimated share of its poses that align, in [0, 1]: the mean over batches, near `aligned / descents`.
    accepted: float


class SampleReport(TypedDict):
    """Random poses, followed exactly, that the Sum and its interval come from."""

    #: Name of the method that followed them.
    method: str
    #: Its settings.
    settings: Any
    #: Seed of the random numbers.
    seed: int
    #: Poses followed.
    descents: int
    #: Share of the error box that the grid misclassifies, accepted or not, in [0, 1]; 1 in reports of versions that did not count it.
    differing: float
    #: Its 95 % interval.
    differing_ci95: list[float]
    #: Where they lay.
    strata: list[Stratum]


class AcceptanceReport(TypedDict):
    """The accepted set in numbers."""

    #: The measure of the accepted set, in `unit`: the unbiased estimate where there is a `sample`, what certainly docks where there is a `certificate`, else `sum_grid`.
    sum: float
    #: Unit of `sum`, like `D²·rad³`.
    unit: str
    #: 95 % interval of the true measure, from the poses of `sample` or the listed ones, drawn at random. Null if nothing was.
    sum_ci95: list[float] | None
    #: The measure of the accepted cells; of listed poses, their share of the error box.
    sum_grid: float
    #: Where there is a `certificate`, what certainly docks, and that with what is undecided. Else `sum_grid` without the accepted cells that touch a rejected one, and with the rejected cells that touch an accepted one: the doubt of resolution, no confidence interval. Null for listed poses.
    sum_bracket: list[float] | None
    #: `sum` as a share of the error box, in [0, 1].
    fraction: float
    #: Cells or poses tried.
    cells: int
    #: How many met each outcome.
    outcomes: Outcomes
    #: Random poses, followed exactly, that correct the Sum; null if none were.
    sample: SampleReport | None


class Interval(TypedDict):
    """An interval along an axis."""

    #: Which error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: Lower end, D or rad.
    lo: float
    #: Upper end, D or rad.
    hi: float


class OnaaReport(TypedDict):
    """The largest axis-oriented n-cube in the accepted set."""

    #: Its edge after each axis is divided by its range: in [0, 1].
    edge: float
    #: Where it lies; empty if the edge is 0.
    bounds: list[Interval]
    #: Whether poses were followed to find its size, so that it does not rest on cells; false in reports of versions that did not.
    followed: bool


class CenteredReport(TypedDict):
    """The largest n-cube around zero in the accepted set."""

    #: Its edge after each axis is divided by its range: in [0, 1].
    edge: float
    #: Where it lies.
    bounds: list[Interval]
    #: The border of the error box stopped it: it may be larger.
    reaches_border: bool
    #: Whether poses were followed to find its size, so that it does not rest on cells; false in reports of versions that did not.
    followed: bool
    #: How many random poses of it were followed last, all of which dock.
    sampled: NotRequired[int | None]


class ToleranceReport(TypedDict):
    """How far one error may go alone."""

    #: Which error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: `D` or `rad`.
    unit: Literal['D', 'rad']
    #: Below zero; not negative.
    minus: float
    #: Above zero; not negative.
    plus: float
    #: Uncertainty of both: half a cell, or half the distance between a pose that docks and one that does not.
    half_cell: float
    #: Whether poses were followed along the axis, so that it does not rest on cells; false in reports of versions that did not.
    followed: bool
    #: The border of the error box stopped `minus`: it may be larger.
    minus_reaches_border: bool
    #: The border of the error box stopped `plus`: it may be larger.
    plus_reaches_border: bool


class UprightReport(TypedDict):
    """What a connector tolerates whose roll and pitch are locked."""

    #: The largest box around zero all of which docks, in the proportions of the tolerances; its edge is a multiple of these.
    window: CenteredReport
    #: How far each error may go alone.
    tolerances: list[ToleranceReport]


class SuccessReport(TypedDict):
    """Success probability for a distribution of errors."""

    #: How the errors are distributed.
    distribution: dict[str, Any]
    #: Probability that an error is accepted, in [0, 1]; errors outside the error box count as failures.
    probability: float
    #: The same with the cells at the border of the accepted set counted as failures, and as successes.
    bracket: list[float]
    #: 95 % interval of `probability`; null where it is an exact sum over cells.
    ci95: list[float] | None
    #: Probability of an error outside the error box.
    outside: float


class Choice(TypedDict):
    """The tolerance that was used, and why."""

    #: Basins shallower than this were merged, in D.
    depth: float
    #: Why this one.
    reason: dict[str, Any]


class PoseError(TypedDict):
    """A pose error: lateral offset of the moving *face centre* (D) and the Euler angles (radians)."""

    #: Offset of the face centre along x, in D.
    x: float
    #: Offset of the face centre along y, in D.
    y: float
    #: Rotation about x, in radians.
    roll: float
    #: Rotation about y, in radians.
    pitch: float
    #: Rotation about z, in radians.
    yaw: float


class BasinReport(TypedDict):
    """A basin after merging."""

    #: What becomes of its poses.
    outcome: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: The pose error of its lowest cell.
    minimum: PoseError
    #: Height there; null where nothing touches.
    height: float | None
    #: How far the water must rise to reach a lower minimum; null if there is none.
    depth: float | None
    #: How far the water must rise to run over into any other basin; null where nothing touches, or for the only basin.
    escape: float | None
    #: Cells that drain to it.
    cells: int
    #: Their share of the error box.
    fraction: float


class ToleranceStepReport(TypedDict):
    """A step of the accepted share over the tolerance."""

    #: It holds for tolerances above this.
    above: float
    #: Accepted cells.
    cells: int
    #: Their measure, in the unit of the Sum.
    sum: float
    #: Their share of the error box.
    fraction: float


class BasinsReport(TypedDict):
    """Basins of a flooded landscape. Depths and heights in D."""

    #: Basins shallower than `tolerance.depth` were merged, and why at that depth.
    tolerance: Choice
    #: Minima before merging.
    minima: int
    #: Basins after merging.
    merged: int
    #: The basins after merging that hold the most cells, the largest first, at most `LISTED`.
    largest: list[BasinReport]
    #: What every tolerance accepts: each step holds for tolerances above its own, up to the next one's. Steps that change the accepted set by less than `SMALLEST_STEP` of the error box are left out.
    staircase: list[ToleranceStepReport]


class WatershedsReport(TypedDict):
    """Watersheds of a flooded grid; that of the cells without contact is none of them."""

    #: Before merging.
    first: int
    #: After merging.
    merged: int
    #: Cells between two of them, before merging.
    dams: int
    #: Cells whose watershed was merged into another.
    moved: int
    #: Share of all cells whose first watershed was merged into another.
    moved_share: float


class PartitionCounts(TypedDict):
    """How much there was of everything."""

    #: Polytopes of the Minkowski sum.
    polytopes: int
    #: Cells of the contact space.
    cells: int
    #: Parts of cells, each of which drains to one other.
    parts: int
    #: Places of rest: base watersheds.
    rests: int


class PartitionReport(TypedDict):
    """A partition of the contact space."""

    #: Polytopes of the Minkowski sum, cells of the contact space, parts of cells, and places of rest.
    counts: PartitionCounts
    #: Measure of the accepted polytopes inside the error box, in the unit of the Sum. No grid is involved.
    sum: float


class BoxCertificate(TypedDict):
    """What is certain of an error box."""

    #: Share of the error box whose every pose docks.
    yes: float
    #: Share whose no pose docks.
    no: float
    #: Share that is left open.
    undecided: float
    #: Measures of the three, Dᵃ·radᵇ.
    measures: list[float]
    #: How high a seated half must be lifted before it can leave, above the mated height, in D: at least. Also the energy that it takes per unit of the force that holds it.
    retention_at_least: float
    #: At most; nothing where no way out was found.
    retention_at_most: float | None
    #: The largest window that is certain: every pose docks of the error box, made smaller about zero by this factor, in [0, 1].
    window: float
    #: Boxes that were looked at.
    boxes: int


class Joined(TypedDict):
    """How many cells were decided by others, and how often that was wrong."""

    #: Cells in contact; mirror images count once.
    cells: int
    #: How many of them joined others, on their way or at once.
    joined: int
    #: How many motions were followed, to their end or until they joined others.
    motions: int
    #: Cells that joined others, drawn at random and followed to their end.
    tried: int
    #: How many of these end otherwise than they were labelled.
    wrong: int
    #: 95 % interval of the share of the joined cells that do, in [0, 1].
    wrong_ci95: list[float]


class JamsSettings(TypedDict):
    """What changes the answer."""

    #: Random poses of the error box; 4000 of simple halves where nothing is said, fewer of halves with many facets.
    motions: int | None
    #: Their seed, and that of every search.
    seed: int
    #: Errors that a robot makes: as many poses are drawn from them, too.
    errors: dict[str, Any] | None
    #: How many jams are examined, those with most of the poses.
    examined: int
    #: Coefficient of friction between the halves.
    friction: float
    #: A grid whose merge tree gives depths, too; none by default.
    resolution: str | None
    #: Whether depths are bounded from below, too, by boxes of poses: of simple halves without friction, with one or two free errors as a rule.
    certified: bool


class Share(TypedDict):
    """A count as a share of all, with the uncertainty of a sample."""

    #: How many.
    count: int
    #: Their share of all, in [0, 1].
    share: float
    #: Its 95 % interval (Wilson).
    ci95: list[float]


class JamsOutcomes(TypedDict):
    """Their outcomes."""

    aligned: NotRequired[Share]
    jammed: NotRequired[Share]
    missed: NotRequired[Share]
    undecided: NotRequired[Share]


class JamsExpected(TypedDict):
    """The same of poses drawn from the errors that a robot makes; null where none were given."""

    aligned: NotRequired[Share]
    jammed: NotRequired[Share]
    missed: NotRequired[Share]
    undecided: NotRequired[Share]


Extent = TypedDict(
    "Extent",
    {
        "axis": Literal['x', 'y', 'roll', 'pitch', 'yaw'],
        "from": float,
        "to": float,
    },
)


class NamedFeature(TypedDict):
    """A feature of a half that touches."""

    #: `face`, `edge` or `corner`.
    kind: Literal['face', 'edge', 'corner']
    #: In words: `edge between top and wall`.
    name: str
    #: The number of its part in the design file, from 0; null where halves are not made up of parts of one surface each.
    part: int | None
    #: Where it touches, in the coordinates in which its half was drawn, in D.
    drawn_d: list[float]


class FeatureContact(TypedDict):
    """Two features that touch, and where."""

    #: Where, in the world frame, in D: the places where it carries.
    points_d: list[list[float]]
    #: Unit normal at the first of them, from the fixed half to the moving one.
    normal: list[float]
    #: The feature of the fixed half.
    fixed: NamedFeature
    #: The feature of the moving half.
    moving: NamedFeature


class Immobility(TypedDict):
    """By which order a rest is held (Rimon and Burdick)."""

    #: `first`, `second`, `neutral` or `unstable`.
    order: Literal['first', 'second', 'neutral', 'unstable']
    #: From where to where the least slope of a first-order rest lies, in D per D of the metric of the motion; 0 where first order does not hold.
    slope: list[float]
    #: Independent directions that are free to first order.
    free: int
    #: The least curvature of the height among them, per D: pushed by s it rises by half of it times s². Null where none is free.
    curvature_per_d: float | None
    #: The direction of that: offsets in D and turns in radians; 0 where none is free.
    weakest: PoseError


class Sticking(TypedDict):
    """From which friction on a half may stick where it touches, by Coulomb's law."""

    #: From this friction on forces exist that hold it, 0 where contacts alone do; null: at none.
    holds_from: float | None
    #: Up to this friction there is a way to slip; null: at any.
    slips_until: float | None
    #: From this friction on it wedges, and may hold against a pull straight out as well; null: at none.
    wedges_from: float | None


class EscapePath(TypedDict):
    """A way out of a jam."""

    #: How far the half must be lifted to get out, at most, in D.
    climb_at_most_d: float
    #: Its outcome then: docked, off, or a rest that is lower.
    to: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: The pose error from which motion leads there.
    over: PoseError


class Examined(TypedDict):
    """What was found out about a place of rest."""

    #: `sharp`, `rounded`, `level` or `ridge`.
    firmness: Literal['sharp', 'rounded', 'level', 'ridge']
    #: By how much it is pushed aside, in the metric of the motion, in D.
    push_d: float
    #: The least rise found, in D: the true least is at most that. Null where walls stop it all around.
    rise_at_most_d: float | None
    #: The direction of that push: offsets in D and turns in radians.
    weakest: PoseError
    #: By which order contacts alone hold it; null where they do not hold the load, as where friction does.
    immobility: Immobility | None
    #: From which friction on it may stick; null where it touches nothing.
    sticks: Sticking | None
    #: The lowest way out that was found; null where none was.
    way_out: EscapePath | None
    #: Poses a little off that were followed.
    pushed: int
    #: How many of them came back.
    back: int


class Jam(TypedDict):
    """A place, or places alike, where halves come to rest that do not dock."""

    #: How many poses of the error box end here, and which share that is.
    of_box: Share
    #: Their share of the poses that jam.
    of_jams: float
    #: Their share of the poses that do not dock.
    of_failures: float
    #: The same of the errors that a robot makes; null where none were given.
    expected: Share | None
    #: The pose error of the rest in its middle.
    pose: PoseError
    #: From where to where its rests lie, per free error; images by symmetry laid upon each other.
    extent: list[Extent]
    #: At how many places that are images of each other rests were seen.
    places: int
    #: z of the COR in the world frame, in D.
    height_d: float
    #: How far it is above the mated pose, in D.
    above_mated_d: float
    #: It is the mated pose turned by a symmetry of the halves, and counts as docked where the design has `symmetry` of this; null where it is not.
    docked_with_symmetry: int | None
    #: What touches.
    contacts: list[FeatureContact]
    #: What was found out about it; null of jams that were not examined.
    examined: Examined | None
    #: The depth in the merge tree of a grid, in D: a bound from neither side; null without `resolution`, or where the tree does not have it.
    depth_on_grid_d: float | None
    #: At least so far it must be lifted before it may come to rest elsewhere, in D, certainly; null without `certified`, or where it is not known.
    depth_at_least_d: float | None


class JammingPair(TypedDict):
    """A pair of features, and how often it touches where halves jam."""

    #: Poses of the error box that jam on it.
    count: int
    #: Their share of the poses that jam.
    of_jams: float
    #: Their share of the poses that do not dock.
    of_failures: float
    #: The feature of the fixed half.
    fixed: NamedFeature
    #: The feature of the moving half.
    moving: NamedFeature


class Jams(TypedDict):
    """Where motions rest that do not dock."""

    #: The settings, everything filled in.
    settings: JamsSettings
    #: Random poses of the error box that were followed.
    motions: int
    #: Their outcomes.
    outcomes: JamsOutcomes
    #: The same of poses drawn from the errors that a robot makes; null where none were given.
    expected: JamsExpected | None
    #: The table that those poses come from; null where they were not measured.
    measured: str | None
    #: The jams, the one with most of the poses first.
    jams: list[Jam]
    #: Which pairs of features touch in jams, the one that does so most often first.
    features: list[JammingPair]


class WindowSettings(TypedDict):
    """What changes the answer."""

    #: Half-widths that are given, in the order of `Dof::ALL`, in D and radians: these errors occur so far, and the others are asked about.
    fixed: list[float | None]
    #: Proportions of the others; the ranges of the error box where nothing is said. 0 for errors that do not occur.
    proportions: PoseError | None
    #: Random poses of the certificate; 300 000 where nothing is said, of halves with many facets as many as can be followed in three core-seconds.
    motions: int | None
    #: Their seed, and that of the search.
    seed: int
    #: Coefficient of friction between the halves.
    friction: float


class WindowAxis(TypedDict):
    """One error of a window, in D or radians."""

    #: Which error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: ± so much is in the window.
    half_width: float
    #: Whether that was given.
    given: bool
    #: ± so far with all others 0.
    alone: float
    #: The error box ends there.
    alone_reaches_border: bool
    #: ± so far with all others anywhere within their half-widths.
    beside: float
    #: The error box ends there.
    beside_reaches_border: bool


class Touch(TypedDict):
    """A point where the halves touch."""

    #: Where, in the world frame, in D.
    point_d: list[float]
    #: Unit normal, from the fixed half to the moving one.
    normal: list[float]


class Worst(TypedDict):
    """The pose nearest to zero, in proportions, that does not dock."""

    #: The pose error.
    error: PoseError
    #: Its outcome.
    outcome: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: Where it ends.
    end: PoseError
    #: What touches there, in the world frame of the fixed face centre, in D, with the normal towards the moving half; empty where the halves never meet.
    touches: list[Touch]


class WindowCertificate(TypedDict):
    """The evidence of random poses of the window: none of them failed."""

    #: How many poses.
    motions: int
    #: At most this share of the window fails, with 95 % confidence; 1 if nothing was tried.
    failing_at_most: float
    #: Windows before this one in which some random pose failed.
    redrawn: int


class WindowSection(TypedDict):
    """A window in the report of a run: its half-widths by name beside everything else that was found."""

    x: NotRequired[float]
    y: NotRequired[float]
    roll: NotRequired[float]
    pitch: NotRequired[float]
    yaw: NotRequired[float]
    #: The settings, everything filled in.
    settings: WindowSettings
    #: Every free error.
    sides: list[WindowAxis]
    #: Half-widths that were not given are so many times their proportions.
    scale: float
    #: The error that is nearest to its limit while all others are anywhere within the window; null where all reach the error box.
    tightest: Literal['x', 'y', 'roll', 'pitch', 'yaw'] | None
    #: The nearest pose, in proportions, that does not dock; null where the window reaches the error box.
    worst: Worst | None
    #: The evidence of random poses.
    certificate: WindowCertificate
    #: Exact motions in all.
    motions: int


class Play(TypedDict):
    """How far one error may be off at rest."""

    #: Which error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: Below zero; not negative. D or radians.
    minus: float
    #: Above zero; not negative. D or radians.
    plus: float


class Residual(TypedDict):
    """How far off docked poses rest along one error, whichever way. D or radians."""

    #: Which error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: Mean.
    mean: float
    #: 95 % of the poses rest nearer.
    p95: float
    #: The farthest.
    most: float


class Deeper(TypedDict):
    """A place of rest below the mated pose, in the same seat."""

    #: How much deeper, in D.
    sinks: float
    #: Where.
    error: PoseError


class Seating(TypedDict):
    """The seat, and what comes to rest in it."""

    #: How far above its mated height a half may lie and be seated, in D.
    depth: float
    #: How far off it may rest and lie as deep, per free error that matters; no less than what docked poses were seen to use.
    play: list[Play]
    #: Accepted poses that were followed until they had come to rest.
    poses: int
    #: How far off they rested, per free error that matters; empty if there were none.
    residual: list[Residual]
    #: The deepest of them, if it lay deeper than the mated pose, which then is none.
    deeper: NotRequired[Deeper | None]


class WarningReport(TypedDict):
    """A doubt, for programs and for people. A kind of doubt that this version does not know is read as a `Warning::Note` of its sentence."""

    #: The doubt itself, with its `kind`.
    warning: dict[str, Any]
    #: The same as a sentence.
    message: str


class Timing(TypedDict):
    """How long it took. The only part of a report that differs between equal runs."""

    #: Wall-clock time of the computation, in seconds.
    total_s: float
    #: Worker threads.
    threads: int


class RunReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Which report this is.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: Name of the method that decided.
    method: str
    #: The method's settings: what else changes the answer.
    settings: Any
    #: The axes of the error grid, the first one fastest; empty for listed poses.
    axes: list[AxisReport]
    #: The accepted set.
    acceptance: AcceptanceReport
    #: The largest axis-oriented cube; null for listed poses.
    onaa: OnaaReport | None
    #: The largest cube around zero; null for listed poses.
    centered: CenteredReport | None
    #: How far each error may go alone; empty for listed poses.
    tolerances: list[ToleranceReport]
    #: The same with roll and pitch locked, where all five errors are free and motions were followed; null otherwise, and in reports of versions that did not ask.
    upright: UprightReport | None
    #: Success probability for the errors asked about; null if none were.
    success: SuccessReport | None
    #: The basins behind the outcomes; null for methods that know none.
    basins: BasinsReport | None
    #: The watersheds behind the outcomes, before merging and after; null for methods that flood nothing, and in reports of versions that did not count them.
    watersheds: WatershedsReport | None
    #: The polytopes behind the outcomes; null for all methods but `partition`.
    partition: PartitionReport | None
    #: What is certain of the error box and of the seat; null for all methods but `certified`, and in reports of versions without it.
    certificate: BoxCertificate | None
    #: How many cells joined others, and how often that was wrong; null for all methods but `confluence`, and in reports of versions that did not know it.
    joined: Joined | None
    #: Where motions rest that do not dock; null where that was not asked, and in reports of versions that did not ask.
    jams: Jams | None
    #: The largest box of errors that all dock; null where that was not asked or there is none, and in reports of versions that did not ask.
    window: WindowSection | None
    #: The seat, and how far off accepted poses rest in it; null in reports of versions that did not ask.
    seat: Seating | None
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[WarningReport]
    #: Wall-clock time and threads; null where nothing is computed for long. Never compared.
    timing: Timing | None


class HalfWidths(TypedDict):
    """An object of the report."""

    x: NotRequired[float]
    y: NotRequired[float]
    roll: NotRequired[float]
    pitch: NotRequired[float]
    yaw: NotRequired[float]


class WindowReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Which report this is.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: ± so much of every free error, by its name, in D and radians.
    window: HalfWidths
    #: The settings, everything filled in.
    settings: WindowSettings
    #: Every free error.
    sides: list[WindowAxis]
    #: Half-widths that were not given are so many times their proportions.
    scale: float
    #: The error that is nearest to its limit while all others are anywhere within the window; null where all reach the error box.
    tightest: Literal['x', 'y', 'roll', 'pitch', 'yaw'] | None
    #: The nearest pose, in proportions, that does not dock; null where the window reaches the error box.
    worst: Worst | None
    #: The evidence of random poses.
    certificate: WindowCertificate
    #: Exact motions in all.
    motions: int
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[WarningReport]
    #: Wall-clock time and threads; null where nothing is computed for long. Never compared.
    timing: Timing | None


class JamsReportOutcomes(TypedDict):
    """Their outcomes."""

    aligned: NotRequired[Share]
    jammed: NotRequired[Share]
    missed: NotRequired[Share]
    undecided: NotRequired[Share]


class JamsReportExpected(TypedDict):
    """The same of poses drawn from the errors that a robot makes; null where none were given."""

    aligned: NotRequired[Share]
    jammed: NotRequired[Share]
    missed: NotRequired[Share]
    undecided: NotRequired[Share]


class JamsReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Which report this is.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: The settings, everything filled in.
    settings: JamsSettings
    #: Random poses of the error box that were followed.
    motions: int
    #: Their outcomes.
    outcomes: JamsReportOutcomes
    #: The same of poses drawn from the errors that a robot makes; null where none were given.
    expected: JamsReportExpected | None
    #: The table that those poses come from; null where they were not measured.
    measured: str | None
    #: The jams, the one with most of the poses first.
    jams: list[Jam]
    #: Which pairs of features touch in jams, the one that does so most often first.
    features: list[JammingPair]
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[WarningReport]
    #: Wall-clock time and threads; null where nothing is computed for long. Never compared.
    timing: Timing | None


class WaypointReport(TypedDict):
    """One moment of a motion."""

    #: Path length since the first of them, in the ρ-metric, in D.
    travelled_d: float
    #: Since it was let go, in s; null of quasi-static motions, which take no time.
    time_s: float | None
    #: The pose error.
    error: PoseError
    #: z of the COR in the world frame, in D.
    height_d: float
    #: Where the halves touch.
    touches: list[Touch]


class TraceReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Which report this is.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: Name of the method that followed the pose.
    method: str
    #: Its settings.
    settings: Any
    #: The pose error that the path starts from.
    start: PoseError
    #: How it ends.
    outcome: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: Why it does not dock; null where that is not known.
    reason: Literal['crossed'] | None
    #: The last pose error; null if the halves never meet.
    end: PoseError | None
    #: From first contact on; of a drop test from where it was let go.
    waypoints: list[WaypointReport]
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[WarningReport]
    #: Wall-clock time and threads; null where nothing is computed for long. Never compared.
    timing: Timing | None


#: Its fields depend on the design.
ZraaReport = dict[str, Any]


class MethodResult(TypedDict):
    """What one method found."""

    #: The measure of the accepted cells.
    sum_grid: float
    #: The Sum: corrected where the method draws random poses.
    sum: float
    #: Its 95 % interval, if there is one.
    sum_ci95: list[float] | None
    #: The ONAA edge.
    onaa_edge: float | None
    #: Wall-clock time, in seconds.
    seconds: float


class ComparedMethod(TypedDict):
    """One method of many."""

    #: Its name.
    method: str
    #: What it found.
    result: MethodResult | None
    #: Why it found nothing.
    left_out: str | None


class PairAgreement(TypedDict):
    """How two methods agree."""

    #: Share of the cells that both accept or both reject.
    agreement: float
    #: Accepted by both over accepted by any.
    jaccard: float


class MethodsReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Which report this is.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: Cells per axis, by axis.
    cells: list[int]
    #: Seconds that each method could take.
    time_limit_s: float
    #: Unit of the Sums.
    unit: str
    #: Every method there is. Seconds differ between equal runs, and where time stops a method so does its result.
    methods: list[ComparedMethod]
    #: Of the methods that came to a result, in their order: how each two agree.
    agreement: list[list[PairAgreement]]
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[WarningReport]
    #: Wall-clock time and threads; null where nothing is computed for long. Never compared.
    timing: Timing | None


class Compared(TypedDict):
    """One of the two."""

    #: Where it comes from: the path that was given.
    source: str
    #: Everything about it, over its own grid.
    report: RunReport


class Quantiles(TypedDict):
    """What a list of distances is like."""

    #: Half of them are at most this.
    median: float
    #: 95 % of them are at most this.
    p95: float
    #: The largest.
    max: float


class Distances(TypedDict):
    """Distances of the cells that differ from the border of the first set."""

    #: In cells.
    cells: Quantiles
    #: In units of the error box: each axis divided by its range.
    error_box: Quantiles


class Comparison(TypedDict):
    """How two acceptances compare."""

    #: Poses compared.
    poses: int
    #: `confusion[i][j]`: poses with outcome i by the first and j by the second, in the order of `Outcome::ALL`.
    confusion: list[list[int]]
    #: Accepted by both, over accepted by any; 1 where nothing is accepted.
    jaccard: float
    #: Share of the poses that both accept or both reject.
    agreement: float
    #: Poses that the first alone accepts.
    only_first: int
    #: Poses that the second alone accepts.
    only_second: int
    #: Measure of each accepted set over these poses, Dᵃ·radᵇ.
    sums: list[float]
    #: The unit of the measures, like `D²·rad³`.
    unit: str
    #: Second over first; null where the first accepts nothing.
    sum_ratio: float | None
    #: ONAA edges; null for listed poses.
    onaa_edges: list[float] | None
    #: Second over first; null where the first accepts nothing, and for listed poses.
    onaa_ratio: float | None
    #: How far from the border of the first set the two differ; null where they do not, where there is no border, and for listed poses.
    distances: Distances | None


class ComparisonReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Which report this is.
    kind: str
    #: The first.
    first: Compared
    #: The second.
    second: Compared
    #: The axes of the grid on which they are compared; empty for listed poses.
    axes: list[AxisReport]
    #: How they compare.
    comparison: Comparison
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[WarningReport]
    #: Wall-clock time and threads; null where nothing is computed for long. Never compared.
    timing: Timing | None
