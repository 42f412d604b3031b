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
    """Docking tolerance. `Seat` of the module `contact` defines its effect on a pair of halves."""

    #: Largest height above the mated height at which a half at rest counts as docked, in D.
    depth: float
    #: Largest residual misalignment that counts as docked, in the order of `Dof::ALL`: D and radians; null: the play of the seat, limited.
    limits: list[float | None]


class Alignment(TypedDict):
    """The alignment problem of a pair of halves. Stored with every result."""

    #: Errors that occur and that contact may correct. The others are locked: rotations at 0, translations at the COR.
    free: list[Literal['x', 'y', 'roll', 'pitch', 'yaw']]
    #: Rotations that do not count in the outcome (yaw of a round plug); they are locked during motion.
    dont_care: list[Literal['x', 'y', 'roll', 'pitch', 'yaw']]
    #: Signed distance of the COR in front of the face centre, in D.
    center_of_rotation: float
    #: Characteristic length ρ: overdamped motion dissipates `\|v\|² + (ρD)²·\|ω\|²`, v at the COR. In D.
    rotation_length: float
    #: The half turn that mounts the moving half.
    mount: Literal['x', 'y']
    #: n-fold symmetry about the approach axis: a pair rotated by a multiple of 2π/n also counts as docked.
    symmetry: int
    #: Half-ranges of the error box in the order of `Dof::ALL`: D and radians. Only those of free errors count.
    half_ranges: list[float]
    #: Docking tolerance.
    docked: Docked


class Design(TypedDict):
    """A checked design: lengths in D, angles in radians."""

    #: Name given by the user.
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

    #: The error.
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

    #: Docked: contact brings the halves to the mated pose.
    aligned: int
    #: The moving half rests in contact outside the seat.
    jammed: int
    #: The halves never touch, or the moving half slides off.
    missed: int
    #: The step budget ended before the motion did.
    undecided: int


class Stratum(TypedDict):
    """Results of a stratum."""

    #: Poses that the stratum contains.
    name: str
    #: Its share of the error box, in [0, 1]; exact.
    share: float
    #: Number of poses followed in the stratum.
    descents: int
    #: Number of them that docked.
    aligned: int
    #: Number of them that could not be followed to their end.
    undecided: int
    #: Estimated share of the stratum that docks, in [0, 1]: the mean over batches, close to `aligned / descents`.
    accepted: float


class SampleReport(TypedDict):
    """Sampled poses, followed exactly, behind the Sum and its interval."""

    #: Name of the method that followed them.
    method: str
    #: Its settings.
    settings: Any
    #: Seed of the random numbers.
    seed: int
    #: Number of poses followed.
    descents: int
    #: Share of the error box that the grid misclassifies, accepted or not, in [0, 1]; 1 in reports of older versions.
    misclassified: float
    #: Its 95 % interval.
    misclassified_ci95: list[float]
    #: The strata.
    strata: list[Stratum]


class AcceptanceReport(TypedDict):
    """Measures of the accepted set."""

    #: The Sum, in `unit`: the unbiased estimate if there is a `sample`, the certified measure if there is a `certificate`, else `sum_grid`.
    sum: float
    #: Unit of `sum`, like `D²·rad³`.
    unit: str
    #: 95 % interval of the true measure, from the poses of `sample` or from listed poses sampled at random. Null without samples.
    sum_ci95: list[float] | None
    #: Measure of the accepted cells; for listed poses, their share of the error box.
    sum_grid: float
    #: With a `certificate`: the certified measure, and that plus the undecided measure. Without: `sum_grid` minus the accepted cells that touch a rejected cell, and plus the rejected cells that touch an accepted cell. This is the uncertainty of the resolution, not a confidence interval. Null for listed poses.
    sum_bracket: list[float] | None
    #: `sum` as a share of the error box, in [0, 1].
    fraction: float
    #: Number of cells or poses decided.
    cells: int
    #: Number of cells or poses with each outcome.
    outcomes: Outcomes
    #: Sampled poses, followed exactly, that correct the Sum; null without samples.
    sample: SampleReport | None


class Interval(TypedDict):
    """An interval along an axis."""

    #: The error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: Lower end, D or rad.
    lo: float
    #: Upper end, D or rad.
    hi: float


class Onaa(TypedDict):
    """The largest axis-oriented n-cube in the accepted set."""

    #: Edge of the cube, with each axis divided by its range: in [0, 1].
    edge: float
    #: Bounds of the cube, of several the one with its centre nearest to zero; empty if the edge is 0.
    bounds: list[Interval]
    #: Whether exact motions determined the size, independently of the cells; false in reports of older versions.
    followed: bool


class CenteredBox(TypedDict):
    """The largest box around zero in the accepted set."""

    #: Size relative to the wanted proportions; for the cube, its edge with each axis divided by its range: in [0, 1].
    edge: float
    #: Bounds of the box, from −h to h along each axis.
    bounds: list[Interval]
    #: Whether the border of the error box limits the box, so that it may be larger.
    reaches_border: bool
    #: Whether exact motions determined the size, independently of the cells; false in reports of older versions.
    followed: bool
    #: Number of sampled poses of the final box, all of which dock.
    sampled: NotRequired[int | None]
    #: Errors that limit the box: with one of them slightly larger and the others inside it a pose fails; absent if the cells determined the size.
    limited_by: NotRequired[list[Literal['x', 'y', 'roll', 'pitch', 'yaw']]]


class Tolerance(TypedDict):
    """Single-axis limits of an error, in D or radians."""

    #: The error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: `D` or `rad`.
    unit: Literal['D', 'rad']
    #: Limit below zero; not negative.
    minus: float
    #: Limit above zero; not negative.
    plus: float
    #: Uncertainty of both: half a cell, or half the distance between a success and a failure.
    half_cell: float
    #: Whether exact motions along the axis determined the limits, independently of the cells; false in reports of older versions.
    followed: bool
    #: Whether `minus` ends at the border of the error box, so that it may be larger.
    minus_reaches_border: bool
    #: Whether `plus` ends at the border of the error box, so that it may be larger.
    plus_reaches_border: bool


class Upright(TypedDict):
    """Figures of merit of the connector with roll and pitch locked."""

    #: The largest box around zero in which every sampled pose docks, in the proportions of the tolerances; its edge is a multiple of these.
    window: CenteredBox
    #: Single-axis limits of each error.
    tolerances: list[Tolerance]


class SuccessProbability(TypedDict):
    """Success probability for a distribution of errors."""

    #: Distribution of the errors.
    distribution: dict[str, Any]
    #: Probability that an error is accepted, in [0, 1]; errors outside the error box count as failures.
    probability: float
    #: The probability with border cells of the accepted set counted as failures, and as successes.
    bracket: list[float]
    #: Wilson's 95 % interval of `probability`; null for an exact sum over cells.
    ci95: list[float] | None
    #: Probability of an error outside the error box.
    outside: float


class Choice(TypedDict):
    """The tolerance that was used, and the reason for it."""

    #: Basins shallower than this were merged, in D.
    depth: float
    #: Reason for this tolerance.
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

    #: Outcome of its poses.
    outcome: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: The pose error of its lowest cell.
    minimum: PoseError
    #: Height of its lowest cell; null without contact.
    height: float | None
    #: Height that the water must rise to reach a lower minimum; null if no minimum is lower.
    depth: float | None
    #: Height that the water must rise to overflow into any other basin; null without contact, or for a single basin.
    escape: float | None
    #: Cells that drain to it.
    cells: int
    #: Their share of the error box.
    fraction: float


class ToleranceStepReport(TypedDict):
    """A step of the accepted share as a function of the tolerance."""

    #: The step holds for tolerances above this.
    above: float
    #: Accepted cells.
    cells: int
    #: Their measure, in the unit of the Sum.
    sum: float
    #: Their share of the error box.
    fraction: float


class BasinsReport(TypedDict):
    """Basins of a flooded landscape. Depths and heights in D."""

    #: Depth below which basins were merged, and the reason for it.
    tolerance: Choice
    #: Minima before merging.
    minima: int
    #: Basins after merging.
    merged: int
    #: The basins after merging with the most cells, largest first, at most `LISTED`.
    largest: list[BasinReport]
    #: The accepted set for every tolerance: each step holds for tolerances above its own, up to that of the next step. Steps that change the accepted set by less than `SMALLEST_STEP` of the error box are left out.
    staircase: list[ToleranceStepReport]


class WatershedsReport(TypedDict):
    """Watersheds of a flooded grid, without the region of cells without contact."""

    #: Before merging.
    first: int
    #: After merging.
    merged: int
    #: Cells between two watersheds, before merging.
    dams: int
    #: Cells whose watershed was merged into another.
    moved: int
    #: Share of all cells whose first watershed was merged into another.
    moved_share: float


class PartitionCounts(TypedDict):
    """Size of a partition."""

    #: Number of polytopes of the Minkowski sum.
    polytopes: int
    #: Number of cells of the contact space.
    cells: int
    #: Number of parts of cells; each part drains to a single other part.
    parts: int
    #: Number of rests: base watersheds.
    rests: int


class PartitionReport(TypedDict):
    """A partition of the contact space."""

    #: Numbers of polytopes of the Minkowski sum, cells of the contact space, parts of cells, and rests.
    counts: PartitionCounts
    #: Measure of the accepted polytopes inside the error box, in the unit of the Sum, independent of any grid.
    sum: float


class BoxCertificate(TypedDict):
    """Certified shares of an error box."""

    #: Share of the error box in which every pose docks.
    yes: float
    #: Share in which no pose docks.
    no: float
    #: Share that is undecided.
    undecided: float
    #: Measures of the three, Dᵃ·radᵇ.
    measures: list[float]
    #: Certified lower bound on the retention: the height above the mated height that a seated half must reach before it can leave, in D. Also the energy per unit of the force that holds it.
    retention_at_least: float
    #: Certified upper bound on the retention; null if no escape path was found.
    retention_at_most: float | None
    #: Certified window: every pose docks in the error box scaled about zero by this factor, in [0, 1].
    window: float
    #: Number of boxes examined.
    boxes: int


class InheritedLabels(TypedDict):
    """Number of cells with an inherited label, and how often that label was wrong."""

    #: Cells in contact; mirror images count once.
    cells: int
    #: Cells that inherited their label, during their motion or at its start.
    inherited: int
    #: Motions that were followed, to their end or until they inherited a label.
    motions: int
    #: Cells with an inherited label that were sampled at random and followed to their end.
    tried: int
    #: Number of these cells whose exact outcome differs from their label.
    wrong: int
    #: 95 % interval of the share of misclassified cells among the inherited labels, in [0, 1].
    wrong_ci95: list[float]


class JamsSettings(TypedDict):
    """Settings that change the result."""

    #: Number of poses sampled from the error box. Default: 4000 for simple halves, fewer for halves with many facets.
    motions: int | None
    #: Seed of the samples and of every search.
    seed: int
    #: Pose-error distribution of a robot: if given, as many poses are also sampled from it.
    errors: dict[str, Any] | None
    #: Number of jams to examine, those with the largest basins first.
    examined: int
    #: Coefficient of friction between the halves.
    friction: float
    #: Grid whose merge tree also gives escape heights; null: no grid.
    resolution: str | None
    #: Whether to certify lower bounds on escape heights by boxes of poses: for simple halves without friction, usually with one or two free errors.
    certified: bool


class Share(TypedDict):
    """A count as a share of all, with its sampling uncertainty."""

    #: The count.
    count: int
    #: The count divided by the total, in [0, 1].
    share: float
    #: 95 % interval of the share (Wilson).
    ci95: list[float]


class JamsOutcomes(TypedDict):
    """Outcomes of the sampled poses."""

    aligned: NotRequired[Share]
    jammed: NotRequired[Share]
    missed: NotRequired[Share]
    undecided: NotRequired[Share]


class JamsExpected(TypedDict):
    """Outcomes of poses sampled from the errors of the robot; null if no errors were given."""

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
    """A feature of a half in contact."""

    #: `face`, `edge` or `corner`.
    kind: Literal['face', 'edge', 'corner']
    #: Description, such as `edge between top and wall`.
    name: str
    #: Number of its part in the design file, from 0; null if the half does not consist of parts with one surface each.
    part: int | None
    #: Contact point in the coordinates in which the half was drawn, in D.
    drawn_d: list[float]


class FeatureContact(TypedDict):
    """A contact between two features."""

    #: Contact points in the world frame, in D: the points that carry force.
    points_d: list[list[float]]
    #: Contact normal at the first point: unit vector from the fixed half to the moving half.
    normal: list[float]
    #: The feature of the fixed half.
    fixed: NamedFeature
    #: The feature of the moving half.
    moving: NamedFeature


class Immobility(TypedDict):
    """Immobility of a rest by its contacts (Rimon and Burdick)."""

    #: `first`, `second`, `neutral` or `unstable`.
    order: Literal['first', 'second', 'neutral', 'unstable']
    #: Bounds on the smallest slope of a first-order rest, in D per D of the metric of the motion; 0 if the rest is not first-order immobile.
    slope: list[float]
    #: Independent directions that are free to first order.
    free: int
    #: Smallest curvature of the height among these directions, per D: a displacement s raises it by half of this times s². Null if no direction is free.
    curvature_per_d: float | None
    #: The direction of smallest curvature: offsets in D and rotations in radians; 0 if no direction is free.
    weakest: PoseError


class Sticking(TypedDict):
    """Friction coefficients at which a touching half may stick, by Coulomb's law."""

    #: Sticking threshold: from this friction coefficient on, forces exist that hold the half; 0 if the contacts hold it without friction; null: never.
    holds_from: float | None
    #: Slipping threshold: up to this friction coefficient the half can slip; null: always.
    slips_until: float | None
    #: From this friction coefficient on the half wedges and may also resist a straight pull; null: never.
    wedges_from: float | None


class EscapePath(TypedDict):
    """An escape path from a jam."""

    #: Upper bound on the escape height, in D.
    climb_at_most_d: float
    #: Outcome at its end: docked, missed, or jammed at a lower rest.
    to: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: The pose error on the path from which the motion to that end starts.
    over: PoseError


class Examined(TypedDict):
    """Results of the examination of a rest."""

    #: `sharp`, `rounded`, `level` or `ridge`.
    stability: Literal['sharp', 'rounded', 'level', 'ridge']
    #: Displacement of the test, in the metric of the motion, in D.
    push_d: float
    #: Smallest rise found, in D: an upper bound on the true minimum. Null if walls block every direction.
    rise_at_most_d: float | None
    #: Direction of the smallest rise: offsets in D and rotations in radians.
    weakest: PoseError
    #: Immobility by the contacts alone; null if they do not balance the load without friction.
    immobility: Immobility | None
    #: Friction thresholds for stiction; null if the half touches nothing.
    sticks: Sticking | None
    #: Lowest escape path that was found; null if the search found no path.
    escape_path: EscapePath | None
    #: Number of nearby poses that were followed.
    displaced: int
    #: Number of these that returned to the rest.
    returned: int


class Jam(TypedDict):
    """A rest outside the seat, or several equivalent ones."""

    #: Poses of the error box that end here: number and share.
    of_box: Share
    #: Share of the jammed poses that end here.
    of_jams: float
    #: Share of the failed poses that end here.
    of_failures: float
    #: Poses from the errors of the robot that end here; null if no errors were given.
    expected: Share | None
    #: Pose error of the central rest.
    pose: PoseError
    #: Range of the rests in each free error, with symmetric images mapped onto each other.
    extent: list[Extent]
    #: Number of symmetric images of this place at which rests were observed.
    places: int
    #: z of the COR in the world frame, in D.
    height_d: float
    #: Height above the mated pose, in D.
    above_mated_d: float
    #: The value of `symmetry` with which this rest would count as docked, because it is the mated pose rotated by a symmetry of the halves; null if it is no such pose.
    docked_with_symmetry: int | None
    #: The contacts.
    contacts: list[FeatureContact]
    #: Results of the examination; null for a jam that was not examined.
    examined: Examined | None
    #: Escape height in the merge tree of a grid, in D; neither an upper nor a lower bound; null without `resolution`, or if the tree does not contain the rest.
    depth_on_grid_d: float | None
    #: Certified lower bound on the escape height to another rest, in D; null without `certified`, or if no bound is known.
    depth_at_least_d: float | None


class JammingPair(TypedDict):
    """A pair of features, and how often they are in contact in jams."""

    #: Number of poses of the error box that jam on this pair.
    count: int
    #: Share of the jammed poses.
    of_jams: float
    #: Share of the poses that fail to dock.
    of_failures: float
    #: The feature of the fixed half.
    fixed: NamedFeature
    #: The feature of the moving half.
    moving: NamedFeature


class Jams(TypedDict):
    """The jams of a pair: rests outside the seat."""

    #: The settings, with all defaults filled in.
    settings: JamsSettings
    #: Number of poses sampled from the error box and followed.
    motions: int
    #: Outcomes of the sampled poses.
    outcomes: JamsOutcomes
    #: Outcomes of poses sampled from the errors of the robot; null if no errors were given.
    expected: JamsExpected | None
    #: The table of measured errors from which those poses come; null if the errors were not measured.
    measured: str | None
    #: The jams, largest basin first.
    jams: list[Jam]
    #: Pairs of features in contact in jams, most frequent first.
    features: list[JammingPair]


class WindowSettings(TypedDict):
    """Settings that change the result."""

    #: Given half-widths, in the order of `Dof::ALL`, in D and radians: these errors have this range, and the window is sought for the others.
    fixed: list[float | None]
    #: Proportions of the other half-widths; by default the ranges of the error box. 0 for errors that do not occur.
    proportions: PoseError | None
    #: Number of samples for the certificate. Default: 300 000; for halves with many facets as many as can be followed in three core-seconds.
    motions: int | None
    #: Seed of the samples and of the search.
    seed: int
    #: Coefficient of friction between the halves.
    friction: float


class WindowAxis(TypedDict):
    """One error of a window, in D or radians."""

    #: The error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: Half-width of the window in this error.
    half_width: float
    #: Whether the half-width was given.
    given: bool
    #: Single-axis limit: tolerance ± while all other errors are 0.
    alone: float
    #: Whether the single-axis limit is the border of the error box.
    alone_reaches_border: bool
    #: Tolerance ± while all other errors vary within their half-widths.
    beside: float
    #: Whether that tolerance ends at the border of the error box.
    beside_reaches_border: bool


class Touch(TypedDict):
    """A contact point of the halves."""

    #: Position in the world frame, in D.
    point_d: list[float]
    #: Contact normal: unit vector from the fixed half to the moving half.
    normal: list[float]


class Worst(TypedDict):
    """The nearest failure: the failing pose nearest to zero, in proportions of the window."""

    #: The pose error.
    error: PoseError
    #: Its outcome.
    outcome: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: Pose error at the end of its motion.
    end: PoseError
    #: Contacts at the end, in the world frame of the fixed face centre, in D, with normals towards the moving half; empty if the halves never touch.
    touches: list[Touch]


class WindowCertificate(TypedDict):
    """The certificate: sampled poses of the window, none of which failed."""

    #: Number of sampled poses.
    motions: int
    #: Upper bound on the failing share of the window, at 95 % confidence; 1 if no pose was sampled.
    failing_at_most: float
    #: Number of earlier windows that were rejected because a sampled pose failed.
    redrawn: int


class WindowSection(TypedDict):
    """A window in the report of a run: its half-widths by name, and its details."""

    x: NotRequired[float]
    y: NotRequired[float]
    roll: NotRequired[float]
    pitch: NotRequired[float]
    yaw: NotRequired[float]
    #: The settings, with all defaults filled in.
    settings: WindowSettings
    #: Every free error.
    sides: list[WindowAxis]
    #: Factor between `proportions` and the half-widths that were not given.
    scale: float
    #: The error with the least room to its limit while all others vary within the window; null if every limit is the border of the error box.
    tightest: Literal['x', 'y', 'roll', 'pitch', 'yaw'] | None
    #: The nearest failure, measured in proportions of the window; null if the window reaches the error box.
    worst: Worst | None
    #: The certificate from sampled poses.
    certificate: WindowCertificate
    #: Number of exact motions in total.
    motions: int


class Play(TypedDict):
    """Play of the seat in one error."""

    #: The error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: Play towards negative values, as a magnitude ≥ 0. D or radians.
    minus: float
    #: Play towards positive values, ≥ 0. D or radians.
    plus: float


class Residual(TypedDict):
    """Residual misalignment of docked poses in one error, as absolute values. D or radians."""

    #: The error.
    axis: Literal['x', 'y', 'roll', 'pitch', 'yaw']
    #: Mean.
    mean: float
    #: 95 % of the poses have less.
    p95: float
    #: Maximum.
    most: float


class Deeper(TypedDict):
    """A rest below the mated pose, in the same seat."""

    #: Depth below the mated pose, in D.
    sinks: float
    #: Pose error of this rest.
    error: PoseError


class Seating(TypedDict):
    """The seat, and the residual misalignment of docked poses."""

    #: Largest height above the mated height at which a half at rest counts as docked, in D.
    depth: float
    #: Play of the seat per free error that counts; at least as large as the residual misalignment of the docked poses.
    play: list[Play]
    #: Number of accepted poses that were followed to rest.
    poses: int
    #: Residual misalignment of these poses per free error that counts; empty if no pose was followed.
    residual: list[Residual]
    #: The deepest rest, if it lies below the mated pose, which is then not a rest itself.
    deeper: NotRequired[Deeper | None]


class Diagnostic(TypedDict):
    """An error of an input, or a warning or note about a result. A stored warning of a kind that this version does not know is read as a `Warning::Note` with its sentence."""

    #: How much it matters.
    severity: Literal['error', 'warning', 'note']
    #: Its stable code, in kebab case.
    code: str
    #: Its description, a sentence or several.
    message: str
    #: Advice, as words.
    help: str | None
    #: The numbers of a warning, with its `kind`.
    warning: NotRequired[dict[str, Any] | None]


class Timing(TypedDict):
    """Time of the computation. Only this part of a report differs between equal runs."""

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
    #: Kind of the report.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: Name of the method that decided the outcomes.
    method: str
    #: The settings of the method.
    settings: Any
    #: The axes of the error grid, the first one fastest; empty for listed poses.
    axes: list[AxisReport]
    #: The accepted set.
    acceptance: AcceptanceReport
    #: The largest axis-oriented cube; null for listed poses.
    onaa: Onaa | None
    #: The largest cube around zero; null for listed poses.
    centered: CenteredBox | None
    #: Single-axis limits of each error; empty for listed poses.
    tolerances: list[Tolerance]
    #: Figures of merit with roll and pitch locked, if all five errors are free and motions were followed; null if not, and in reports of older versions.
    upright: Upright | None
    #: Success probability for the given errors; null if no errors were given.
    success: SuccessProbability | None
    #: The basins behind the outcomes; null for methods without basins.
    basins: BasinsReport | None
    #: The watersheds behind the outcomes, before and after merging; null for methods without flooding, and in reports of older versions.
    watersheds: WatershedsReport | None
    #: The polytopes behind the outcomes; null for all methods but `partition`.
    partition: PartitionReport | None
    #: Certified shares of the error box and certified retention; null for all methods but `certified`, and in reports of older versions.
    certificate: BoxCertificate | None
    #: Number of cells with an inherited label, and how often it was wrong; null for all methods but `confluence`, and in reports of older versions.
    inherited: InheritedLabels | None
    #: Rests outside the seat; null if not requested, and in reports of older versions.
    jams: Jams | None
    #: The tolerance window; null if not requested, if there is no window, and in reports of older versions.
    window: WindowSection | None
    #: The seat, and the residual misalignment of accepted poses; null in reports of older versions.
    seat: Seating | None
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[Diagnostic]
    #: Wall-clock time and threads; null for reports without a long computation. Never compared.
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
    #: Kind of the report.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: Half-width of every free error, by its name, in D and radians.
    window: HalfWidths
    #: The settings, with all defaults filled in.
    settings: WindowSettings
    #: Every free error.
    sides: list[WindowAxis]
    #: Factor between `proportions` and the half-widths that were not given.
    scale: float
    #: The error with the least room to its limit while all others vary within the window; null if every limit is the border of the error box.
    tightest: Literal['x', 'y', 'roll', 'pitch', 'yaw'] | None
    #: The nearest failure, measured in proportions of the window; null if the window reaches the error box.
    worst: Worst | None
    #: The certificate from sampled poses.
    certificate: WindowCertificate
    #: Number of exact motions in total.
    motions: int
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[Diagnostic]
    #: Wall-clock time and threads; null for reports without a long computation. Never compared.
    timing: Timing | None


class JamsReportOutcomes(TypedDict):
    """Outcomes of the sampled poses."""

    aligned: NotRequired[Share]
    jammed: NotRequired[Share]
    missed: NotRequired[Share]
    undecided: NotRequired[Share]


class JamsReportExpected(TypedDict):
    """Outcomes of poses sampled from the errors of the robot; null if no errors were given."""

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
    #: Kind of the report.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: The settings, with all defaults filled in.
    settings: JamsSettings
    #: Number of poses sampled from the error box and followed.
    motions: int
    #: Outcomes of the sampled poses.
    outcomes: JamsReportOutcomes
    #: Outcomes of poses sampled from the errors of the robot; null if no errors were given.
    expected: JamsReportExpected | None
    #: The table of measured errors from which those poses come; null if the errors were not measured.
    measured: str | None
    #: The jams, largest basin first.
    jams: list[Jam]
    #: Pairs of features in contact in jams, most frequent first.
    features: list[JammingPair]
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[Diagnostic]
    #: Wall-clock time and threads; null for reports without a long computation. Never compared.
    timing: Timing | None


class WaypointReport(TypedDict):
    """A waypoint of a motion."""

    #: Path length since the first waypoint, in the ρ-metric, in D.
    travelled_d: float
    #: Time since release, in s; null for quasi-static motions, which have no time.
    time_s: float | None
    #: The pose error.
    error: PoseError
    #: z of the COR in the world frame, in D.
    height_d: float
    #: Contacts.
    touches: list[Touch]


class TraceReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Kind of the report.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: Name of the method that followed the pose.
    method: str
    #: Its settings.
    settings: Any
    #: The pose error at the start.
    start: PoseError
    #: Outcome of the motion.
    outcome: Literal['aligned', 'jammed', 'missed', 'undecided']
    #: Reason for the failure to dock; null if it is not known.
    reason: Literal['crossed'] | None
    #: The last pose error; null if the halves never meet.
    end: PoseError | None
    #: Waypoints from first contact on; for a drop test from the release on.
    waypoints: list[WaypointReport]
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[Diagnostic]
    #: Wall-clock time and threads; null for reports without a long computation. Never compared.
    timing: Timing | None


#: Its fields depend on the design.
ZraaReport = dict[str, Any]


class MethodResult(TypedDict):
    """Result of a method."""

    #: The measure of the accepted cells.
    sum_grid: float
    #: The Sum; corrected if the method draws samples.
    sum: float
    #: Its 95 % interval, if there is one.
    sum_ci95: list[float] | None
    #: Edge of the ONAA cube.
    onaa_edge: float | None
    #: Wall-clock time, in seconds.
    seconds: float


class ComparedMethod(TypedDict):
    """Result of a single method."""

    #: Name of the method.
    method: str
    #: Result of the method; null without a result.
    result: MethodResult | None
    #: Reason for the missing result.
    left_out: str | None


class PairAgreement(TypedDict):
    """Agreement of two methods."""

    #: Share of the cells that both accept or both reject.
    agreement: float
    #: Jaccard index: cells accepted by both, divided by cells accepted by either.
    jaccard: float


class MethodsReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Kind of the report.
    kind: str
    #: The design, resolved: lengths in D, angles in radians.
    design: Design
    #: Number of cells of each axis.
    cells: list[int]
    #: Time limit for each method, in seconds.
    time_limit_s: float
    #: Unit of the Sums.
    unit: str
    #: All methods. Seconds differ between equal runs, and so does the result of a method that the time limit stops.
    methods: list[ComparedMethod]
    #: For the methods with a result, in their order: the agreement of each pair.
    agreement: list[list[PairAgreement]]
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[Diagnostic]
    #: Wall-clock time and threads; null for reports without a long computation. Never compared.
    timing: Timing | None


class Compared(TypedDict):
    """One side of a comparison."""

    #: Path that was given for it.
    source: str
    #: Its report, over its own grid.
    report: RunReport


class Quantiles(TypedDict):
    """Quantiles of a list of distances."""

    #: Half of the distances are at most this.
    median: float
    #: 95 % of the distances are at most this.
    p95: float
    #: The largest distance.
    max: float


class Distances(TypedDict):
    """Distances of the differing cells from the border of the first set."""

    #: In cells.
    cells: Quantiles
    #: In units of the error box: each axis divided by its range.
    error_box: Quantiles


class Comparison(TypedDict):
    """Comparison of two acceptances."""

    #: Number of poses compared.
    poses: int
    #: `confusion[i][j]`: number of poses with outcome i in the first and j in the second, in the order of `Outcome::ALL`.
    confusion: list[list[int]]
    #: Jaccard index: poses accepted by both, divided by poses accepted by either; 1 if neither accepts a pose.
    jaccard: float
    #: Share of the poses that both accept or both reject.
    agreement: float
    #: Number of poses that only the first accepts.
    only_first: int
    #: Number of poses that only the second accepts.
    only_second: int
    #: Measure of each accepted set over these poses, Dᵃ·radᵇ.
    sums: list[float]
    #: The unit of the measures, like `D²·rad³`.
    unit: str
    #: Sum of the second divided by that of the first; null if the first accepts no pose.
    sum_ratio: float | None
    #: ONAA edges; null for listed poses.
    onaa_edges: list[float] | None
    #: ONAA of the second divided by that of the first; null if the first accepts no pose, and for listed poses.
    onaa_ratio: float | None
    #: Distances of the differing cells from the border of the first set; null if no cell differs, if there is no border, and for listed poses.
    distances: Distances | None


class ComparisonReport(TypedDict):
    """The form of a report in JSON."""

    #: Version of the layout.
    schema: int
    #: Version of the program that wrote it.
    catchment: str
    #: Kind of the report.
    kind: str
    #: The first.
    first: Compared
    #: The second.
    second: Compared
    #: The axes of the common grid; empty for listed poses.
    axes: list[AxisReport]
    #: The comparison.
    comparison: Comparison
    #: Warnings about the numbers: a code and a sentence each.
    warnings: list[Diagnostic]
    #: Wall-clock time and threads; null for reports without a long computation. Never compared.
    timing: Timing | None
