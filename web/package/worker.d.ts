import type { Robot as OwnRobot, SnugModule, Surface as OwnSurface } from "./snug.js";

/** What a call in a worker may also have among its options. */
export interface Watched {
  /** Rejects the promise with its reason, and ends the work: within milliseconds, in any case. */
  signal?: AbortSignal;
  /** Called with the fraction done. */
  progress?: (done: number) => void;
}
// Surfaces and robots of the worker in place of those here.
type There<T> = T extends OwnSurface ? Surface
  : T extends OwnRobot ? Robot
  : T extends { surface: OwnSurface } ? Omit<T, "surface"> & { surface: Surface }
  : T extends readonly (infer E extends { surface: OwnSurface })[] ? There<E>[]
  : T;
type Given<T> = There<T> extends infer Own ? (Own extends Surface | readonly unknown[] ? Own : Own extends object ? Own & Watched : Own) : never;
type Later<Function> = Function extends (...args: infer Args) => infer Answer
  ? (...args: { [I in keyof Args]: Given<Args[I]> }) => Promise<There<Answer>>
  : never;

/** A surface in the worker. */
export type Surface = { [Name in keyof OwnSurface]: OwnSurface[Name] extends (...args: any[]) => any ? Later<OwnSurface[Name]> : OwnSurface[Name] };
/** A robot in the worker. */
export type Robot = { [Name in keyof OwnRobot]: OwnRobot[Name] extends (...args: any[]) => any ? Later<OwnRobot[Name]> : OwnRobot[Name] };
/** The functions of SnugModule, each with a promise of its answer. An aborted call ends the worker; another one takes its place, with the
 *  surfaces of before. */
export type SnugInWorker = { [Name in keyof SnugModule]: Later<SnugModule[Name]> } & {
  /** Ends the worker. */
  close(): Promise<void>;
};
/** Starts workers of the package's own, where a page or Node has them; options as in Snug(). threads (1): collideMany() and distanceMany() share
 *  their poses out to so many, another call goes to the one with the least to do; each holds all surfaces. */
export default function SnugWorker(options?: { wasm?: ArrayBuffer | Uint8Array; simd?: boolean; threads?: number }): SnugInWorker;
