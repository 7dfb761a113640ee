/** A rigid transform, row by row: R | t. Taken without change, and refused unless it is rigid within 1e-9. */
export type Pose = readonly number[] | Float64Array;
export type Point = [number, number, number];
/** Contains the exact value. */
export type Interval = [lower: number, upper: number];
/** How a search ended; answers hold in any case. */
export type Outcome = "complete" | "budget-spent" | "at-rounding";
export type Verdict = "separated" | "within" | "intersecting" | "undecided";
export type Scheme = "loop" | "catmark" | "doo-sabin" | "midedge" | "bilinear" | "flat";
export type Boundary = "none" | "edge-only" | "edge-and-corner";

/** What the library refuses: the message names the file, line, face or vertex, and the next step. */
export class SnugError extends Error {
  readonly problem: "unreadable" | "refused" | "pose" | "value" | "unrepresentable" | "memory";
}

export interface ReadOptions {
  /**
   * Default, auto: flat for STL and glTF unless `sharp` is given; else that of the file if it names one; else loop if all
   * faces are triangles, with a note, or catmark.
   */
  scheme?: Scheme | "auto";
  /** Default: the file's tag, else edge-and-corner. */
  boundary?: Boundary;
  /** Edges with a larger angle between face normals, in degrees, stay sharp; for parts from CAD. */
  sharp?: number;
  /** Merge vertices this close; 0: equal ones. */
  weld?: number;
  /** Bound every patch at the first query: later ones are faster. */
  tight?: boolean;
}

/** Where a point lies: parameters on a face; in a dual scheme, on a vertex. */
export interface Place {
  owner: number;
  corner: number;
  u: number;
  v: number;
}
export interface WitnessPlace extends Place {
  normal: Point | null;
  normalError: number | null;
}

export interface SearchStats {
  boxTests: number;
  triangleTests: number;
  evaluations: number;
  splits: number;
}

/** Poses default to where the files put the parts; lengths are in mesh units. */
export interface PairOptions {
  poseA?: Pose;
  poseB?: Pose;
  /** Compare the solids that closed surfaces bound: one inside the other intersects it. */
  solid?: boolean;
  maxSplits?: number;
  /** Prove the answer, too: docs/certificates.md. */
  certificate?: boolean;
}
export interface CollideOptions extends PairOptions {
  /** Surfaces this close may be reported as within. Default: 0.1 % of the larger size. */
  tolerance?: number;
  /** Required clearance, 0 by default. */
  margin?: number;
  /** Narrow the interval of separated surfaces, and give witnesses: about ten microseconds more. */
  measure?: boolean;
  /** Before "within", try to prove "intersecting": some tens of microseconds for a contact. */
  proveContact?: boolean;
}
export interface DistanceOptions extends PairOptions {
  /** Largest width of the interval. Default: 0.01 % of the larger size. */
  absolute?: number;
  /** Or this fraction of its upper end. */
  relative?: number;
}

export interface Collision {
  verdict: Verdict;
  outcome: Outcome;
  /** The upper end is Infinity if no pair of points was near enough to matter. */
  distance: Interval;
  /** The two closest points found, on A and on B. */
  witness: [Point, Point] | null;
  /** Upper bound, per coordinate, of how far a witness is from the limit point it stands for. */
  witnessError: number | null;
  witnessAt: [WitnessPlace | null, WitnessPlace | null] | null;
  /** With solid: 0 if A has a surface point inside B, 1 the other way round. */
  contained: 0 | 1 | null;
  stats: SearchStats;
  certificate?: Certificate;
}
/** A proof that the program snug-check verifies, empty if there is none, and what it does not prove. */
export interface Certificate {
  text: string;
  missing: string;
}
export interface Distance {
  distance: Interval;
  outcome: Outcome;
  witness: [Point, Point];
  witnessError: number;
  witnessAt: [WitnessPlace | null, WitnessPlace | null];
  contained: 0 | 1 | null;
  stats: SearchStats;
  certificate?: Certificate;
}
export interface Penetration {
  depth: Interval;
  /** To be added to B's pose: proved to separate the solids. */
  translation: Point;
  outcome: Outcome;
}
export interface ClosestPoint {
  distance: Interval;
  outcome: Outcome;
  point: Point;
  error: number;
  at: Place;
}

/** The control mesh: face f has the corners from offsets[f] to offsets[f + 1]. */
export interface Cage {
  points: Float64Array;
  offsets: Uint32Array;
  corners: Uint32Array;
}
type Numbers = readonly number[] | Float64Array | Float32Array | Uint32Array | Uint16Array | Int32Array;
/** A control mesh, of flat arrays: points x y z, and either triangles of three vertices each, or the faces as in Cage. */
export interface MeshArrays {
  points: Numbers;
  triangles?: Numbers;
  offsets?: Numbers;
  corners?: Numbers;
  /** Two vertices and a sharpness each; from 10 on an edge stays sharp. */
  creases?: Numbers;
  /** A vertex and a sharpness each. */
  sharpCorners?: Numbers;
  /** Faces without a surface. */
  holes?: Numbers;
}
/** What a BufferGeometry of three.js has. */
export interface Geometry {
  attributes: Record<string, { count: number; getX(i: number): number; getY(i: number): number; getZ(i: number): number } | any>;
  index: { array: ArrayLike<number> } | null;
}

/** Limit points and normals on a lattice of 2^level steps a patch; each patch has its own. For drawing. */
export interface Samples {
  positions: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  /** Upper bound of the error of all coordinates. */
  error: number;
}
export interface Tessellation {
  positions: Float64Array;
  normals: Float64Array;
  triangles: Uint32Array;
  /** Of each triangle the face; in a dual scheme, the vertex. */
  owners: Uint32Array;
  /** Proved, both ways. */
  errorBound: number;
  outcome: Outcome;
}
export interface BoundOptions {
  /** Split until each radius is at most half of this. */
  error?: number;
  /** Without it: split every patch this many times. */
  level?: number;
  maxSplits?: number;
}
/** Of piece i: base has 9 numbers, three corners of the triangle whose sweep by radius[i] contains it; lower and upper have 9
 *  numbers each, three boxes whose hull contains it, too. */
export interface Enclosures {
  count: number;
  maxRadius: number;
  outcome: Outcome;
  owners: Uint32Array;
  parts: Uint32Array;
  levels: Uint32Array;
  pieces: string[];
  base: Float64Array;
  radius: Float64Array;
  lower: Float64Array;
  upper: Float64Array;
}
/** Hulls of the three boxes, to draw: triangles and edges without indices. */
export interface EnclosureShapes {
  count: number;
  maxRadius: number;
  positions: Float32Array;
  edges: Float32Array;
}
export interface Hull {
  positions: Float64Array;
  triangles: Uint32Array;
  owners: Uint32Array;
  gap: number;
}
export interface Hulls {
  inner: Hull | null;
  outer: Hull | null;
  /** "complete": they are proved not to meet the surface, each other and themselves. */
  outcome: Outcome;
  closed: boolean;
  problems: { fault: string; inner: boolean; place: Point; owner: number | null }[];
}

/** A closed mesh around the surface. */
export interface Envelope {
  positions: Float64Array;
  triangles: Uint32Array;
  error: number;
  clearance: number;
  volume: Interval;
  /** "complete": proved closed, and between clearance and error from the surface. */
  outcome: Outcome;
  problems: Hulls["problems"];
}
export interface RayHit {
  /** Contains a hit, if certified, else maybe; in lengths of the direction. */
  t: Interval;
  certified: boolean;
  /** 1 where the ray leaves on the side of the normal, -1 on the other, 0 where that is not known. */
  side: -1 | 0 | 1;
  point: Point;
  error: number;
  normal: Point | null;
  at: Place | null;
}
export interface RayHits {
  hits: RayHit[];
  outcome: Outcome;
  /** Is it proved that there is a hit, or that there is none? */
  certainHit: boolean;
  certainMiss: boolean;
}
export interface SurfacePoint {
  point: Point;
  error: number;
  tangents: [Point, Point];
  differentiable: boolean;
  normal: Point | null;
  normalError: number | null;
}
export type SelfVerdict = "clear" | "intersecting" | "near" | "undecided";
export interface SelfContact {
  verdict: SelfVerdict;
  outcome: Outcome;
  /** The places that the verdict rests on, at most 100. */
  pairs: {
    verdict: SelfVerdict;
    /** Of facets: no point in common is inside of both. */
    touching: boolean;
    distance: Interval;
    witness: [Point, Point];
    witnessError: number;
    witnessAt: [WitnessPlace, WitnessPlace];
  }[];
}
export interface TimeOfContact {
  verdict: Verdict;
  outcome: Outcome;
  /** No common point before its lower end; the upper one is Infinity if none was found. */
  time: Interval;
  witness: [Point, Point] | null;
  witnessError: number | null;
  witnessAt: [WitnessPlace | null, WitnessPlace | null] | null;
  contained: 0 | 1 | null;
  steps: number;
  stats: SearchStats;
}
export interface OneSidedDistance {
  distance: Interval;
  /** The farthest point found, off by at most `error` a coordinate, and a point of the other set near it. */
  point: Point;
  error: number;
  at: Place | null;
  nearest: Point;
}
export interface Deviation {
  fromSurface: OneSidedDistance;
  fromCandidate: OneSidedDistance;
  outcome: Outcome;
}

/** A limit surface. It lives outside of JavaScript's memory: delete() it. */
export interface Surface {
  /** Longest side of the box of the vertices that faces use. */
  readonly size: number;
  readonly scheme: Scheme;
  readonly boundary: Boundary;
  /** What the reader dropped although it changes the surface, and that triangles are smoothed though nobody said so. */
  readonly notes: string[];
  cage(): Cage;
  samples(level?: number): Samples;
  tessellate(options: {
    error?: number;
    maxEdge?: number;
    maxAngle?: number;
    maxTriangles?: number;
    maxSplits?: number;
  }): Tessellation;
  enclosures(options?: BoundOptions): Enclosures;
  enclosureShapes(options?: BoundOptions): EnclosureShapes;
  hull(options?: { error?: number; inner?: boolean; outer?: boolean; maxSplits?: number }): Hulls;
  /** A closed mesh around the surface, whatever it is; error: 1 % of the size, clearance: a quarter of that. */
  envelope(options?: { error?: number; clearance?: number; maxSplits?: number }): Envelope;
  evaluate(at: Place): SurfacePoint;
  /** signed: negative inside a closed surface. */
  closestPoint(
    point: Point | readonly number[],
    options?: { absolute?: number; relative?: number; signed?: boolean; maxSplits?: number },
  ): ClosestPoint;
  /** Inside a closed surface? null where that cannot be decided. */
  contains(point: Point | readonly number[]): boolean | null;
  /** From `from` (0) to `to` (Infinity), in lengths of the direction. absolute: intended length of an interval. */
  ray(
    origin: Point | readonly number[],
    direction: Point | readonly number[],
    options?: { query?: "nearest" | "any" | "all"; from?: number; to?: number; absolute?: number; maxSplits?: number },
  ): RayHits;
  /** within: are points so near to each other farther apart than `radius` along the surface? */
  selfContact(options?: { within?: number; radius?: number; maxSplits?: number }): SelfContact;
  /** How far the limit surface may be from the faces of its control mesh; null with a dual scheme. */
  limitToFaces(): number | null;
  /** volume is null unless the surface is closed. */
  measure(options?: { relative?: number; maxSplits?: number }): { area: Interval; volume: Interval | null; outcome: Outcome };
  delete(): void;
}

export interface SnugModule {
  /** Reads OBJ, OFF, PLY, STL, USD or glTF; the ending of the name says which. */
  read(name: string, data: string | ArrayBuffer | ArrayBufferView, options?: ReadOptions): Surface;
  fromArrays(arrays: MeshArrays, options?: ReadOptions): Surface;
  /** The triangles of a BufferGeometry of three.js: flat, and equal vertices merged, unless the options say otherwise. */
  fromGeometry(geometry: Geometry, options?: ReadOptions): Surface;
  collide(a: Surface, b: Surface, options?: CollideOptions): Collision;
  distance(a: Surface, b: Surface, options?: DistanceOptions): Distance;
  /** Of two closed surfaces: the shortest translation that separates the solids. */
  penetration(a: Surface, b: Surface, options?: { poseA?: Pose; poseB?: Pose; relative?: number; maxSplits?: number }): Penetration;
  /** When do moving surfaces first touch? Motions pass through a list of poses, one unit of time from each to the next. */
  timeOfContact(
    a: Surface,
    b: Surface,
    options?: { motionA?: readonly Pose[]; motionB?: readonly Pose[]; tolerance?: number; solid?: boolean; proveContact?: boolean; maxSplits?: number },
  ): TimeOfContact;
  /** How far triangles deviate from a surface, and it from them. */
  deviation(
    surface: Surface,
    triangles: { positions: Numbers; triangles: Numbers },
    options?: { absolute?: number; threshold?: number; maxSplits?: number },
  ): Deviation;
  /** after: a pose to begin with; then rotated about an axis (z) through the origin, then moved. */
  pose(steps: { after?: Pose; axis?: readonly number[]; degrees?: number; move?: readonly number[] }): number[];
  /** About six digits of a lower bound, rounded down, and of an upper one, rounded up, as the command prints them. */
  textAtMost(x: number): string;
  textAtLeast(x: number): string;
}

/** Loads the module; `wasm`: the bytes of snug.wasm, where they are not beside snug.js. */
export default function Snug(options?: { wasm?: ArrayBuffer | Uint8Array }): Promise<SnugModule>;
