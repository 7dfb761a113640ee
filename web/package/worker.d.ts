import type { SnugModule, Surface as OwnSurface } from "./snug.js";

/** What a call in a worker may also have among its options. */
export interface Watched {
  /** Rejects the promise with its reason, and ends the work: within milliseconds, in any case. */
  signal?: AbortSignal;
  /** Called with the fraction done. */
  progress?: (done: number) => void;
}
type Sent<T> = T extends OwnSurface ? Surface : T extends readonly (infer E)[] & { length: number } ? T : T;
type Later<Function> = Function extends (...args: infer Args) => infer Answer
  ? (...args: { [I in keyof Args]: Args[I] extends OwnSurface ? Surface : Args[I] extends object | undefined ? (Args[I] & Watched) | Args[I] : Args[I] }) => Promise<Sent<Answer>>
  : never;

/** A surface in the worker. */
export type Surface = { [Name in keyof OwnSurface]: OwnSurface[Name] extends (...args: any[]) => any ? Later<OwnSurface[Name]> : OwnSurface[Name] };
/** The functions of SnugModule, each with a promise of its answer. An aborted call ends the worker; another one takes its place, with the
 *  surfaces of before. */
export type SnugInWorker = { [Name in keyof SnugModule]: Later<SnugModule[Name]> } & {
  /** Ends the worker. */
  close(): Promise<void>;
};
/** Starts a worker of the package's own, where a page or Node has them; `wasm` as in Snug(). */
export default function SnugWorker(options?: { wasm?: ArrayBuffer | Uint8Array }): SnugInWorker;
