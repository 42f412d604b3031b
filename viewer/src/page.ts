// What a page holds, as the program wrote it: the reports with the fields that are shown, and the elements that hold bytes.
// Lengths in D, angles in radians.

export type AxisName = "x" | "y" | "roll" | "pitch" | "yaw";
export const AXES: AxisName[] = ["x", "y", "roll", "pitch", "yaw"];
export const isTurn = (axis: AxisName) => axis !== "x" && axis !== "y";
/** Five numbers in the order of AXES. */
export type Pose = [number, number, number, number, number];
export type NamedPose = Record<AxisName, number>;
export const named = (pose: Pose): NamedPose => ({ x: pose[0], y: pose[1], roll: pose[2], pitch: pose[3], yaw: pose[4] });
export const listed = (pose: NamedPose): Pose => [pose.x, pose.y, pose.roll, pose.pitch, pose.yaw];

export type Outcome = "aligned" | "jammed" | "missed" | "undecided";
/** The codes of cells: 1 to 4. */
export const OUTCOMES: Outcome[] = ["aligned", "jammed", "missed", "undecided"];
export type Point = [number, number, number];

export interface Axis { axis: AxisName; unit: string; lo: number; hi: number; cells: number }
export interface Interval { axis: AxisName; lo: number; hi: number }
export interface Touch { point_d: Point; normal: Point }
export interface Waypoint { travelled_d: number; error: NamedPose; height_d: number; touches: Touch[] }
export interface Trace {
    start: NamedPose;
    outcome: Outcome;
    reason: string | null;
    end: NamedPose | null;
    waypoints: Waypoint[];
}
export interface Design {
    name: string;
    width: number;
    unit: string | null;
    alignment: {
        free: AxisName[]; center_of_rotation: number; rotation_length: number; half_ranges: number[]; symmetry: number;
        docked: { depth: number; limits: (number | null)[] };
    };
}
export interface Run {
    catchment: string;
    design: Design;
    method: string;
    axes: Axis[];
    acceptance: {
        sum: number; unit: string; sum_ci95: [number, number] | null; sum_grid: number; sum_bracket: [number, number] | null;
        fraction: number; cells: number; outcomes: Record<Outcome, number>;
        sample: { poses?: number } | null;
    };
    onaa: { edge: number; bounds: Interval[] } | null;
    centered: { edge: number; bounds: Interval[]; reaches_border: boolean } | null;
    tolerances: {
        axis: AxisName; minus: number; plus: number; half_cell: number; followed: boolean;
        minus_reaches_border: boolean; plus_reaches_border: boolean;
    }[];
    success: { probability: number; bracket: [number, number]; ci95: [number, number] | null; outside: number } | null;
    warnings: { message: string }[];
}
export interface Share { count: number; share: number; ci95: [number, number] }
export interface Feature { kind: string; name: string; drawn_d: Point }
export interface Contact { points_d: Point[]; normal: Point; fixed: Feature; moving: Feature }
export interface Jam {
    of_box: Share; of_jams: number; of_failures: number; pose: NamedPose; places: number; height_d: number; above_mated_d: number;
    contacts: Contact[];
    examined: { stability: string; rise_at_most_d: number | null; escape_path: { climb_at_most_d: number; to: Outcome } | null } | null;
}
export interface Jams { motions: number; outcomes: Record<Outcome, Share>; jams: Jam[]; warnings: { message: string }[] }
export interface Window {
    window: Partial<Record<AxisName, number>>;
    sides: {
        axis: AxisName; half_width: number; given: boolean; alone: number; alone_reaches_border: boolean;
        beside: number; beside_reaches_border: boolean;
    }[];
    tightest: AxisName | null;
    worst: { error: NamedPose; outcome: Outcome; touches: Touch[] } | null;
    certificate: { motions: number; failing_at_most: number };
    motions: number;
}
export interface Page {
    report: Run;
    jams: Jams | null;
    window: Window | null;
    /** The coefficient of friction that the outcomes were decided with. */
    friction: number;
    notes: string[];
    served: boolean;
    chunk_cells: number;
    chunks: number;
    /** The axes of the planes through 0. */
    planes: Axis[][];
}

/** The text of an element that the program wrote; null where it left it out. */
export const text = (id: string): string | null => document.getElementById(id)?.textContent ?? null;

export const page = (): Page => JSON.parse(text("data") ?? "null");
