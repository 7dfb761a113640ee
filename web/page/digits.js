// Six digits of an end of an interval, rounded away from the other end. Where six digits name the same double, that is not yet
// the same number: 0.2 is less than the double nearest to it.
export function six(x, up) {
  const near = Number(x.toPrecision(6));
  const exact = near === x && Number.isInteger(x * 2 ** 16);
  if (exact) return String(near);
  const last = 10 ** (Math.floor(Math.log10(Math.abs(x))) - 5);
  const text = ((up ? near > x : near < x) ? near : near + (up ? last : -last)).toPrecision(6);
  return text.includes("e") ? String(Number(text)) : text;  // both ends with as many digits
}
export const interval = ([lower, upper]) => [six(lower, false), Number.isFinite(upper) ? six(upper, true) : null];
