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
  readonly problem: "unreadable" | "refused" | "pose" | "value" | "unrepresentable" | "memory" | "interrupted";
}

export type Data = string | ArrayBuffer | ArrayBufferView;
export interface ReadOptions {
  /**
   * Default, auto: flat for STL, glTF and 3MF unless `sharp` is given; else that of the file if it names one; else loop if all
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
  /** Other files that this one names, by their paths in its folder; in a worker an object. */
  files?: Record<string, Data> | ((path: string) => Data | undefined);
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


export interface CallOptions {
  maxSplits?: number;
  /** Called with the fraction done; false ends the call, which throws. */
  progress?: (done: number) => boolean | void;
}
/** Poses default to where the files put the parts; lengths are in mesh units. */
export interface PairOptions extends CallOptions {
  poseA?: Pose;
  poseB?: Pose;
  /** Compare the solids that closed surfaces bound: one inside the other intersects it. */
  solid?: boolean;
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

/** A proof that the program snug-check verifies, empty if there is none, and what it does not prove. */
export interface Certificate {
  text: string;
  missing: string;
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

/** Answers to many poses, one after the other. */
export interface ManyDistances {
  lower: Float64Array;
  upper: Float64Array;
  /** With normals: all normals of a piece are at most this angle, in radians, from its axis; NaN where no cone is proved. */
  axes?: Float64Array;
  angles?: Float64Array;
}
export interface ManyCollisions extends ManyDistances {
  /** 0 separated, 1 within, 2 intersecting, 3 undecided. */
  verdicts: Uint8Array;
}
/** Poses default to the identity. */
export interface Part {
  surface: Surface;
  pose?: Pose;
}
/** Two parts by their indices each, instead of all pairs; and two and a margin each. */
export interface SceneOptions {
  pairs?: Numbers;
  margins?: Numbers;
}
/** Answers to pairs that boxes do not separate. */
export interface SceneAnswer<Answer> extends SceneCounts {
  results: (Answer & { a: number; b: number })[];
}
/** Links, or "link#2" where one has several shapes; witnesses are in the frame of the last link that moves both. */
export interface LinkContact extends TimeOfContact {
  a: string;
  b: string;
  frame: string;
}
/** Radians or metres, by joint; others are at 0, or at the limit nearest to it. */
export type Positions = Record<string, number>;
/** Surfaces that move through a list of poses, one unit of time from each to the next. */
export interface MotionOptions extends CallOptions {
  motionA?: readonly Pose[];
  motionB?: readonly Pose[];
  solid?: boolean;
}
/** Counts of a mesh, broken ones too. */
export interface Inspection {
  scheme: Scheme;
  usedVertices: number;
  edges: number;
  boundaryEdges: number;
  components: number;
  closed: boolean;
  /** legal: questions are answered all the same. */
  defects: { kind: string; text: string; legal: boolean }[];
  /** What stands where something else does and is not joined. */
  coincidences: Record<string, number>;
  [count: string]: unknown;
}

/** The file of a Brep. */
export interface Brep {
  text: string;
}

/** Limit points and normals on a lattice of 2^level steps a patch; each patch has its own. For drawing. */
export interface Samples {
  positions: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  /** Upper bound of the error of all coordinates. */
  error: number;
}
export interface BoundOptions extends CallOptions {
  /** Split until each radius is at most half of this. */
  error?: number;
  /** Without it: split every patch this many times. */
  level?: number;
  /** Cones of normals, too. */
  normals?: boolean;
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
export type SelfVerdict = "clear" | "intersecting" | "near" | "undecided";
export type DeviationVerdict = "within" | "exceeds" | "undecided";
export type HullFault =
  | "no-position" | "meets-surface" | "meets-itself" | "meets-other" | "not-around" | "too-few-triangles" | "through-itself";
/** Which triangle of a face (in a dual scheme, of a vertex). */
export interface PatchPlace {
  owner: number;
  part: number;
}
/** With `certificate` among the options. */
export interface Collision {
  certificate?: Certificate;
}
export interface Distance {
  certificate?: Certificate;
}
// Answers, as include/snug/fields.h has them; tests/doors/declarations_test.cpp writes them.
export interface SearchStats {
  /** Pairs of BVH nodes compared. */ boxTests: number;
  /** Pairs of base triangles compared. */ triangleTests: number;
  /** Pairs of limit points evaluated. */ evaluations: number;
  /** Pieces split. */ splits: number;
}
export interface Collision {
  /** 'separated': farther apart than the margin. 'within': at most margin + tolerance apart. 'intersecting': with a point in common. All are proved. 'undecided': none of these was. */ verdict: Verdict;
  /** 'complete', or why the verdict is 'undecided': 'budget-spent' or 'at-rounding'. */ outcome: Outcome;
  /** Contains the distance, in mesh units; the upper end is infinite if no pair of points was near enough to matter. */ distance: Interval;
  /** The two closest points found, on A and on B. */ witness: [Point, Point] | null;
  /** Upper bound, per coordinate, of how far they are from the limit points that they stand for. */ witnessError: number | null;
  /** Null for a witness that was located on the other surface only. */ witnessAt: [WitnessPlace | null, WitnessPlace | null] | null;
  /** With solid: whose surface has a point inside the other, if no crossing was proved. */ contained: 0 | 1 | null;
  /** The work that was done. */ stats: SearchStats;
}
export interface Distance {
  /** 'complete', 'budget-spent' or 'at-rounding'; the answer holds in any case. */ outcome: Outcome;
  /** Contains the distance, in mesh units; [0, 0] if contact is proved. */ distance: Interval;
  /** The two closest points found, on A and on B. */ witness: [Point, Point];
  /** Upper bound, per coordinate, of how far they are from the limit points that they stand for. */ witnessError: number;
  /** Null for a witness that was located on the other surface only. */ witnessAt: [WitnessPlace | null, WitnessPlace | null];
  /** With solid: whose surface has a point inside the other, if no crossing was proved. */ contained: 0 | 1 | null;
  /** The work that was done. */ stats: SearchStats;
}
export interface Penetration {
  /** Contains the depth, in mesh units: no translation shorter than the lower end separates the solids. */ depth: Interval;
  /** Added to B's pose it separates them: proved. Zero if they are separated as they are. */ translation: Point;
  /** 'complete', 'budget-spent' or 'at-rounding'; the answer holds in any case. */ outcome: Outcome;
}
export interface SceneCounts {
  /** All pairs that were asked about. */ pairs: number;
  /** Proved by boxes alone, and not listed. */ separatedByBoxes: number;
  /** Of the others, by their verdicts; distances beyond the limit are separated. */ separated: number;
  /** Likewise. */ within: number;
  /** Likewise; of distances, proved contact. */ intersecting: number;
  /** Likewise. */ undecided: number;
}
export interface TimeOfContact {
  /** 'separated': they never meet. 'within': at the upper end of `time` they are at most the tolerance apart. 'intersecting': they have a common point at some time in `time`. 'undecided': none of these was shown. */ verdict: Verdict;
  /** 'complete', 'budget-spent' or 'at-rounding'; the answer holds in any case. */ outcome: Outcome;
  /** No common point before the lower end; at the upper end they are found near each other, infinite if they are not. */ time: Interval;
  /** The two closest points found at the upper end of `time`, on A and on B. */ witness: [Point, Point] | null;
  /** Upper bound, per coordinate, of how far they are from the limit points that they stand for. */ witnessError: number | null;
  /** Null for a witness that was located on the other surface only. */ witnessAt: [WitnessPlace | null, WitnessPlace | null] | null;
  /** With solid: whose surface has a point inside the other, if no crossing was proved. */ contained: 0 | 1 | null;
  /** Number of times that were looked at. */ steps: number;
  /** The work that was done. */ stats: SearchStats;
}
export interface ClearanceSpan {
  /** From its beginning to its end. */ time: Interval;
  /** Contains the least distance at all times in it. */ distance: Interval;
}
export interface Clearance {
  /** 'complete', 'budget-spent' or 'at-rounding'; the answer holds in any case. */ outcome: Outcome;
  /** Contains the least distance of the whole motion, in mesh units. */ distance: Interval;
  /** A time at which they are at most the upper end of `distance` apart. */ time: number;
  /** The two closest points found at that time, on A and on B. */ witness: [Point, Point];
  /** Upper bound, per coordinate, of how far they are from the limit points that they stand for. */ witnessError: number;
  /** Null for a witness that was located on the other surface only. */ witnessAt: [WitnessPlace | null, WitnessPlace | null];
  /** With solid: whose surface has a point inside the other, if no crossing was proved. */ contained: 0 | 1 | null;
  /** From time 0 to the end, each from where the one before it ends. */ spans: ClearanceSpan[];
  /** Number of times that were looked at. */ steps: number;
  /** The work that was done. */ stats: SearchStats;
}
export interface PatchContact {
  /** Of A and of B. */ patches: [PatchPlace, PatchPlace];
  /** That of these patches. */ verdict: Verdict;
  /** Contains their distance in the region. */ distance: Interval;
}
export interface ContactRegion {
  /** 'intersecting': proved. 'within': the witnesses are at most `within` apart. 'undecided': there may be no contact here. */ verdict: Verdict;
  /** Contains the least distance in the region. */ distance: Interval;
  /** Lower and upper corner of a box around all points in contact. */ box: [Point, Point];
  /** The two closest points found, on A and on B. */ witness: [Point, Point];
  /** Upper bound, per coordinate, of how far they are from the limit points that they stand for. */ witnessError: number;
  /** Null for a witness that was located on the other surface only. */ witnessAt: [WitnessPlace | null, WitnessPlace | null];
  /** Faces of A and of B (of dual schemes vertices). */ owners: [Uint32Array, Uint32Array];
  /** Pairs of patches in contact. */ contacts: PatchContact[];
}
export interface CurveBox {
  /** Contains the curve between two points. */ box: [Point, Point];
  /** Is it proved that one arc leads from one to the other? */ oneArc: boolean;
}
export interface IntersectionCurve {
  /** Which region it is in. */ region: number;
  /** Does it end where it begins? */ closed: boolean;
  /** Does each box contain one arc, and do consecutive arcs meet? */ proved: boolean;
  /** Upper bound of the distance between curve and polyline, either way. */ error: number;
  /** Of an open curve: do its first and last point certainly lie on a border? */ atBorder: [boolean, boolean];
  /** The first point of a closed curve is not repeated. */ points: Float64Array;
  /** Box i contains the curve between points i and i + 1; of a closed curve the last one leads back. */ boxes: CurveBox[];
}
export interface ContactArea {
  /** Which region it is in. */ region: number;
  /** Of A and of B. */ faces: [number, number];
  /** Upper bound, per coordinate, of how far points are from the exact ones. */ error: number;
  /** Corners of a convex polygon, ends of a segment, or a point. */ points: Float64Array;
}
export interface OpenBox {
  /** Lower and upper corner. */ box: [Point, Point];
  /** Of A and of B. */ patches: [PatchPlace, PatchPlace];
  /** Which region it is in. */ region: number;
}
export interface Contacts {
  /** 'complete', or 'budget-spent' or 'at-rounding' where pieces stayed coarser than requested. */ outcome: Outcome;
  /** Do the lists hold all contacts? Not where the budget ended first. */ exhaustive: boolean;
  /** Connected parts of the contact. */ regions: ContactRegion[];
  /** Curves in which the surfaces intersect. */ curves: IntersectionCurve[];
  /** What plane faces that touch have in common. */ areas: ContactArea[];
  /** Boxes in which the surfaces may meet in an unresolved way. */ open: OpenBox[];
}
export interface SelfContactStats {
  /** Neighbourhoods of vertices tested. */ stars: number;
  /** Pairs of pieces tested. */ pairTests: number;
  /** Levels of subdivision that were needed. */ levels: number;
}
export interface SelfContactPair {
  /** 'intersecting', 'near' or 'undecided'. */ verdict: SelfVerdict;
  /** Points on the two pieces, or on both sides of one that turns over. */ witness: [Point, Point];
  /** Upper bound, per coordinate, of how far they are from the limit points that they stand for. */ witnessError: number;
  /** Null for a witness that was located on the other surface only. */ witnessAt: [WitnessPlace | null, WitnessPlace | null];
  /** Contains the distance of the two pieces; [0, 0] where the surface meets itself. */ distance: Interval;
  /** Of facets: have they no point in common that is inside of both? */ touching: boolean;
}
export interface SelfContact {
  /** 'clear': proved, no two parameters have one limit point. 'intersecting': proved. 'near': proved, two points at most `within` apart are farther apart than the radius along the surface. 'undecided'. */ verdict: SelfVerdict;
  /** 'complete', or why the verdict is 'undecided': 'budget-spent' or 'at-rounding'. */ outcome: Outcome;
  /** The radius that was used; 0 without `within`. */ radius: number;
  /** The places that the verdict rests on, at most 100; none if clear. */ pairs: SelfContactPair[];
  /** The work that was done. */ stats: SelfContactStats;
}
export interface ClosestPoint {
  /** Contains the distance, in mesh units; `point` is at most as far away as its upper end. */ distance: Interval;
  /** 'complete', 'budget-spent' or 'at-rounding'; the answer holds in any case. */ outcome: Outcome;
  /** A limit point close to the closest one. */ point: Point;
  /** Upper bound, per coordinate, of the distance of `point` from the limit point that it stands for. */ error: number;
  /** Where it lies. */ at: Place;
}
export interface RayHit {
  /** Contains a hit if `certified`, else maybe; in lengths of the direction. */ t: Interval;
  /** Is a hit in the interval proved? */ certified: boolean;
  /** 1 where the ray leaves on the side of the normal, -1 on the other, 0 where that is not known. */ side: -1 | 0 | 1;
  /** In the middle of the interval. */ point: Point;
  /** Upper bound, per coordinate, of the distance of the ray's points in the interval from `point`. */ error: number;
  /** Close to the parameters of the hit. */ at: Place;
  /** Unit normal there, if there is one. */ normal: Point | null;
}
export interface RayHits {
  /** 'budget-spent': there may be other hits. 'at-rounding': an interval stays wider than requested. */ outcome: Outcome;
  /** By the lower ends of their intervals, in which all hits lie. */ hits: RayHit[];
  /** Is it proved that there is a hit? */ certainHit: boolean;
  /** Is it proved that there is none? */ certainMiss: boolean;
}
export interface SurfacePoint {
  /** The limit point. */ point: Point;
  /** Upper bound, per coordinate, of its distance from the exact one. */ error: number;
  /** Derivatives in u and v where they exist, else two limit tangents. */ tangents: [Point, Point];
  /** Are `tangents` derivatives? */ differentiable: boolean;
  /** Unit normal, if there is one. */ normal: Point | null;
  /** Upper bound of |normal - exact normal|, where one is proved. */ normalError: number | null;
}
export interface BoundSummary {
  /** Number of enclosures. */ count: number;
  /** The largest radius. */ maxRadius: number;
  /** 'complete', 'budget-spent', or 'at-rounding' where 60 levels or rounding ended splitting. */ outcome: Outcome;
  /** Splits in all. */ splits: number;
}
export interface Tessellation {
  /** Corners of triangles. */ positions: Float64Array;
  /** Unit limit normals at `positions`, 0 0 0 where there is none. */ normals: Float64Array;
  /** Rows of `positions`, oriented as the faces. */ triangles: Uint32Array;
  /** Of each triangle the face of the surface (of dual schemes the vertex). */ owners: Uint32Array;
  /** Proved: triangles and surface are nowhere farther apart, either way. */ errorBound: number;
  /** Upper bound, per coordinate, of |position - limit point|. */ positionError: number;
  /** 'complete', or 'budget-spent' where max_splits or max_triangles ended refinement. */ outcome: Outcome;
}
export interface Brep {
  /** Proved: at every parameter a face is no farther than this from the limit point there. */ errorBound: number;
  /** Proved: borders of faces are no farther than this from the edges and vertices on them. */ gapBound: number;
  /** Degrees: the largest angle between faces measured across edges where the surface is smooth. */ breakAngle: number;
  /** 'complete': error and angle are as small as requested; else 'budget-spent' or 'at-rounding'. */ outcome: Outcome;
  /** Closed shells that are not voids. */ solids: number;
  /** Closed shells that are voids of solids. */ voids: number;
  /** Open shells. */ sheets: number;
  /** Number of faces. */ faces: number;
  /** Number of edges. */ edges: number;
  /** Polynomial pieces in all faces. */ spans: number;
}
export interface Hull {
  /** Corners of triangles. */ positions: Float64Array;
  /** Rows of `positions`. */ triangles: Uint32Array;
  /** Of each triangle the face of the surface (of dual schemes the vertex). */ owners: Uint32Array;
  /** Neither the hull nor the surface has a point farther than this from the other. */ gap: number;
}
export interface HullProblem {
  /** What failed. */ fault: HullFault;
  /** Is it the inner hull's? */ inner: boolean;
  /** A point there. */ place: Point;
  /** The face there (of dual schemes the vertex). */ owner: number | null;
}
export interface Hulls {
  /** Does the surface bound a solid? */ closed: boolean;
  /** Behind the surface, inside the solid. */ inner: Hull | null;
  /** In front of the surface, around the solid. */ outer: Hull | null;
  /** 'complete': all guarantees hold; else 'budget-spent' or 'at-rounding'. */ outcome: Outcome;
  /** Unless 'complete', some of the failures. */ problems: HullProblem[];
}
export interface Envelope {
  /** Corners of triangles. */ positions: Float64Array;
  /** Rows of `positions`, oriented outward. */ triangles: Uint32Array;
  /** No point of it is farther than this from the surface. */ error: number;
  /** And none is nearer than this. */ clearance: number;
  /** Contains the volume of the solid that it bounds. */ volume: Interval;
  /** With a gap: rows of `triangles` that are across what it fills, where `error` does not hold. */ bridges: Uint32Array;
  /** No point of these is farther than this from the surface. */ bridgeDistance: number;
  /** 'complete': all guarantees hold; else 'budget-spent' or 'at-rounding'. */ outcome: Outcome;
  /** Unless 'complete', some of the failures. */ problems: HullProblem[];
}
export interface MeasureStats {
  /** Pieces split. */ splits: number;
}
export interface Measures {
  /** 'complete': all are as narrow as requested; else 'budget-spent' or 'at-rounding'. */ outcome: Outcome;
  /** Contains the area. */ area: Interval;
  /** Does the surface bound a solid? */ closed: boolean;
  /** Contains the volume, if the surface is closed. */ volume: Interval | null;
  /** x, y, z; none where the volume may be 0. */ centroid: [Interval, Interval, Interval] | null;
  /** xx, yy, zz, xy, yz, zx of the tensor about the centroid with density 1; none likewise. */ inertia: [Interval, Interval, Interval, Interval, Interval, Interval] | null;
  /** The work that was done. */ stats: MeasureStats;
}
export interface OneSidedDistance {
  /** Contains the greatest distance of a point of one set from the other, in mesh units. */ distance: Interval;
  /** The farthest point found. */ point: Point;
  /** Upper bound, per coordinate, of the distance of `point` from its set. */ error: number;
  /** Where it lies, if its set is a surface. */ at: Place | null;
  /** A point of the other set near it. */ nearest: Point;
}
export interface Deviation {
  /** Of points of the surface from the candidate. */ fromSurface: OneSidedDistance;
  /** Of points of the candidate from the surface. */ fromCandidate: OneSidedDistance;
  /** With solid: how far the candidate lies inside. */ inside: OneSidedDistance | null;
  /** With solid: how far the candidate lies outside. */ outside: OneSidedDistance | null;
  /** With a threshold: 'within', 'exceeds' or 'undecided'. */ verdict: DeviationVerdict | null;
  /** 'complete': each interval is as narrow as requested or, with a threshold, each question answered. */ outcome: Outcome;
}
// End of these answers.

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
    maxThickness?: number;
    view?: { eye: readonly number[]; angle: number };
  } & CallOptions): Tessellation;
  enclosures(options?: BoundOptions): Enclosures;
  enclosureShapes(options?: BoundOptions): EnclosureShapes;
  hull(options?: { error?: number; inner?: boolean; outer?: boolean } & CallOptions): Hulls;
  /** A closed mesh around the surface, whatever it is; error: 1 % of the size, clearance: a quarter of that; gap: openings as wide are filled. */
  envelope(options?: { error?: number; clearance?: number; gap?: number } & CallOptions): Envelope;
  evaluate(at: Place): SurfacePoint;
  /** signed: negative inside a closed surface. */
  closestPoint(
    point: Point | readonly number[],
    options?: { absolute?: number; relative?: number; signed?: boolean } & CallOptions,
  ): ClosestPoint;
  /** Inside a closed surface? null where that cannot be decided. */
  contains(point: Point | readonly number[]): boolean | null;
  /** From `from` (0) to `to` (Infinity), in lengths of the direction. absolute: intended length of an interval. */
  ray(
    origin: Point | readonly number[],
    direction: Point | readonly number[],
    options?: { query?: "nearest" | "any" | "all"; from?: number; to?: number; absolute?: number } & CallOptions,
  ): RayHits;
  /** within: are points so near to each other farther apart than `radius` along the surface? */
  selfContact(options?: { within?: number; radius?: number; levels?: number } & CallOptions): SelfContact;
  /** How far the limit surface may be from the faces of its control mesh; null with a dual scheme. */
  limitToFaces(): number | null;
  measure(options?: { relative?: number } & CallOptions): Measures;
  /** The control mesh after `level` (1) steps of subdivision; limit: at limit positions. */
  subdivided(level?: number, limit?: boolean): Cage;
  /** The bytes of a file of the control mesh; the ending of the name says which: .obj, .off, .ply, .stl, .usda or .glb. */
  write(name?: string): Uint8Array;
  /** A STEP file of B-spline faces that share their edges, for CAD; schemes of quads. error: 0.01 % of the size; units: mm. */
  step(options?: { error?: number; maxAngle?: number; name?: string; units?: "mm" | "cm" | "m" | "inch" | "foot" | "micron"; protocol?: "ap242" | "ap214" } & CallOptions): Brep;
  delete(): void;
}

/** Links in a tree of joints, in metres and radians. It lives outside of JavaScript's memory: delete() it. */
export interface Robot {
  readonly name: string;
  /** Parents first. */
  readonly links: string[];
  /** Limits of the joints that have a position of their own. */
  readonly joints: Record<string, Interval>;
  /** How far meshes of cylinders and spheres go beyond them, at most. */
  readonly outward: number;
  /** Of each link, in the frame of the root. */
  poses(positions?: Positions): Record<string, number[]>;
  /**
   * Which links meet along a path of the joints, at constant speeds from each list of positions to the next? One answer for each two
   * shapes that can move against each other; joined: also of links that a joint joins; group: only with a
   * link of this group. tolerance: 0.1 % of the larger mesh; margin: contact is being at most so far apart.
   */
  firstContacts(path: readonly Positions[], options?: { tolerance?: number; margin?: number; joined?: boolean; group?: string } & CallOptions): LinkContact[];
  delete(): void;
}

export interface SnugModule {
  /** Reads OBJ, OFF, PLY, STL, USD, glTF or 3MF; the ending of the name says which. */
  read(name: string, data: Data, options?: ReadOptions): Surface;
  /** The meshes of a file apart, and where it places them (glTF, 3MF, USD); instances share their surface. */
  readAssembly(name: string, data: Data, options?: ReadOptions): { name: string; surface: Surface; pose: number[] }[];
  /**
   * A robot in URDF; its meshes are among `files`, those of package://NAME/path under NAME/path. srdf: pairs that may touch.
   * visual: what is seen instead of what collides. primitiveError: how far meshes of cylinders and spheres may go beyond them, of the
   * radius (0.002).
   */
  urdf(name: string, data: Data, options?: { srdf?: Data; visual?: boolean; root?: string; primitiveError?: number } & ReadOptions): Robot;
  fromArrays(arrays: MeshArrays, options?: ReadOptions): Surface;
  /** The triangles of a BufferGeometry of three.js: flat, and equal vertices merged, unless the options say otherwise. */
  fromGeometry(geometry: Geometry, options?: ReadOptions): Surface;
  /** What is in a mesh, and what is wrong with it. */
  inspect(arrays: MeshArrays, options?: { scheme?: Scheme | "auto" }): Inspection;
  collide(a: Surface, b: Surface, options?: CollideOptions): Collision;
  distance(a: Surface, b: Surface, options?: DistanceOptions): Distance;
  /** Which of many parts touch? Like collide() and distance() of each pair, up to a limit; margins: where another one holds. */
  collideScene(parts: readonly Part[], options?: CollideOptions & SceneOptions): SceneAnswer<Collision>;
  distanceScene(parts: readonly Part[], limit: number, options?: DistanceOptions & SceneOptions): SceneAnswer<Distance>;
  /** For many poses of B, twelve numbers each: two to ten times as fast as one by one. */
  collideMany(a: Surface, b: Surface, posesB: Numbers, options?: CollideOptions): ManyCollisions;
  distanceMany(a: Surface, b: Surface, posesB: Numbers, options?: DistanceOptions): ManyDistances;
  /** Where they touch: points at most `within` from each other, and curves within `error`; both default to 0.1 % of the larger size. */
  contacts(
    a: Surface,
    b: Surface,
    options?: { poseA?: Pose; poseB?: Pose; within?: number; error?: number; curves?: boolean } & CallOptions,
  ): Contacts;
  /** Of two closed surfaces: the shortest translation that separates the solids. */
  penetration(a: Surface, b: Surface, options?: { poseA?: Pose; poseB?: Pose; relative?: number } & CallOptions): Penetration;
  /** When do moving surfaces first touch, or come within a margin? */
  timeOfContact(a: Surface, b: Surface, options?: { tolerance?: number; margin?: number; proveContact?: boolean } & MotionOptions): TimeOfContact;
  /** How far apart do moving surfaces stay? */
  clearance(a: Surface, b: Surface, options?: { absolute?: number; relative?: number } & MotionOptions): Clearance;
  /** How far another surface or triangles deviate from a surface, and it from them. */
  deviation(
    surface: Surface,
    candidate: Surface | { positions: Numbers; triangles: Numbers },
    options?: { absolute?: number; threshold?: number; solid?: boolean } & CallOptions,
  ): Deviation;
  /** after: a pose to begin with; then rotated about an axis (z) through the origin, then moved. */
  pose(steps: { after?: Pose; axis?: readonly number[]; degrees?: number; move?: readonly number[] }): number[];
  /** About six digits of a lower bound, rounded down, and of an upper one, rounded up, as the command prints them. */
  textAtMost(x: number): string;
  textAtLeast(x: number): string;
}

/**
 * Loads the module: snug.simd.wasm where the engine has vectors and that file is there, else snug.wasm, unless `simd` says which; both
 * give the same bits. `wasm`: the bytes of either, where they are not beside snug.js.
 */
export default function Snug(options?: { wasm?: ArrayBuffer | Uint8Array; simd?: boolean }): Promise<SnugModule>;
