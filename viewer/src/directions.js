// Where things are seen from, in the words of a patient's space or of the axes.
import { Vector3 } from 'three';

// Of RAS. In LPS, x and y run the other way.
const kLetters = [['L', 'R'], ['P', 'A'], ['I', 'S']];
const kSides = [
  ['Front', 'A'], ['Back', 'P'], ['Left side', 'L'], ['Right side', 'R'], ['Top', 'S'], ['Bottom', 'I'],
];
// Without a patient, as isoweave render has them.
const kAxes = [['Front', [0, -1, 0]], ['Back', [0, 1, 0]], ['Left', [-1, 0, 0]], ['Right', [1, 0, 0]],
  ['Top', [0, 0, 1]], ['Bottom', [0, 0, -1]]];
const kTilt = 1e-4; // a view along z needs an upward direction

const isPatient = (space) => space === 'RAS' || space === 'LPS';
const sign = (space, axis) => (space === 'LPS' && axis < 2 ? -1 : 1);

// What stands at the low and at the high end of each axis.
export function axisLetters(space) {
  if (!isPatient(space)) return [['', 'x'], ['', 'y'], ['', 'z']];
  return kLetters.map((ends, axis) => (sign(space, axis) < 0 ? [...ends].reverse() : ends));
}

// The names of the axes, for a choice of one.
export function axisNames(space) {
  if (!isPatient(space)) return ['Along x', 'Along y', 'Along z'];
  return ['Left – right', 'Front – back', 'Bottom – top'];
}

// From where something is seen first: a patient from the front, anything else from a corner.
export function firstDirection(space) {
  if (space === 'RAS') return new Vector3(-0.45, 1, 0.22);
  if (space === 'LPS') return new Vector3(0.45, -1, 0.22);
  return new Vector3(0.65, -1, 0.55);
}

// A patient's front is up in the views from the top and the bottom.
function tilted(direction, space) {
  const front = space === 'RAS' ? 1 : -1;
  const up = isPatient(space) ? front : 1;
  if (direction.z !== 0) direction.y = -up * direction.z * kTilt;
  return direction;
}

// The sides that a view is offered from: { name, direction }.
export function sides(space) {
  if (!isPatient(space)) {
    return kAxes.map(([name, axis]) => ({ name, direction: tilted(new Vector3(...axis), space) }));
  }
  const letters = axisLetters(space);
  return kSides.map(([name, letter]) => {
    const axis = letters.findIndex((ends) => ends.includes(letter));
    const direction = new Vector3().setComponent(axis, letters[axis][1] === letter ? 1 : -1);
    return { name: `${name} (${letter})`, direction: tilted(direction, space) };
  });
}
