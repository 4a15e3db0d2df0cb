// Fields of PhysX's joints that the binding has no setter for, written into the module's memory.
// A joint keeps a pointer to its constant block; the block's place is known by its four unit mass scales, and every
// field's place by the default value that PhysX gives it. Both are checked, so another build cannot be misread in silence.
// Offsets are in words (float32 or uint32) from the start of the block. Source: ExtJoint.h, ExtRevoluteJoint.h, ExtD6Joint.h.

const MAX_FLOAT = 3.4028234663852886e38;

const MASS_SCALES = 0; // PxConstraintInvMassScale: linear0, angular0, linear1, angular1
const REVOLUTE = { driveVelocity: 20, driveForceLimit: 21, driveGearRatio: 22, flags: 32 };
const D6 = { distanceLimit: 26, distanceValue: 31, distanceMinDist: 116, flags: 119 };

// The flags of a PxConstraint, in 16-bit words from its start.
const CONSTRAINT_FLAGS = 14;
const BROKEN = 1;

const REVOLUTE_DRIVE_ENABLED = 2;
const REVOLUTE_DRIVE_FREESPIN = 4;

function constantBlock(px, joint) {
  const words = px.HEAPU32;
  const floats = px.HEAPF32;
  const start = joint.$$.ptr >> 2;
  const pointer = words[start + 20];
  const block = pointer >> 2;
  for (let i = 0; i < 4; i++) {
    if (pointer % 4 !== 0 || floats[block + i] !== 1) {
      throw new Error("the joint's constant block is not where it was in @c-frame/physx 0.3.0");
    }
  }
  return block;
}

function expectFloat(px, block, offset, value) {
  if (px.HEAPF32[block + offset] !== Math.fround(value)) {
    throw new Error(`word ${offset} of a joint is ${px.HEAPF32[block + offset]}, not PhysX's default ${value}`);
  }
}

export function setMassScales(px, joint, scales) {
  const block = constantBlock(px, joint);
  px.HEAPF32.set(scales, block + MASS_SCALES);
}

export function setMotor(px, joint, { velocity, forceLimit = MAX_FLOAT, freeSpin = false }) {
  const block = constantBlock(px, joint);
  expectFloat(px, block, REVOLUTE.driveVelocity, 0);
  expectFloat(px, block, REVOLUTE.driveForceLimit, MAX_FLOAT);
  expectFloat(px, block, REVOLUTE.driveGearRatio, 1);
  px.HEAPF32[block + REVOLUTE.driveVelocity] = velocity;
  px.HEAPF32[block + REVOLUTE.driveForceLimit] = forceLimit;
  px.HEAPU32[block + REVOLUTE.flags] |= REVOLUTE_DRIVE_ENABLED | (freeSpin ? REVOLUTE_DRIVE_FREESPIN : 0);
}

export function setDistanceLimit(px, joint, limit) {
  const block = constantBlock(px, joint);
  expectFloat(px, block, D6.distanceLimit + 4, 0.01);
  expectFloat(px, block, D6.distanceValue, MAX_FLOAT);
  expectFloat(px, block, D6.distanceMinDist, 1e-6);
  const { restitution = 0, bounceThreshold = 0, stiffness = 0, damping = 0, contactDistance = 0.01 } = limit;
  px.HEAPF32.set([restitution, bounceThreshold, stiffness, damping, contactDistance, limit.value], block + D6.distanceLimit);
  // mUseDistanceLimit is the first of the four bytes at the block's end.
  px.HEAPU8[(block + D6.flags) * 4] = 1;
}

export function isBroken(px, joint) {
  return (px.HEAPU16[(joint.getConstraint().$$.ptr >> 1) + CONSTRAINT_FLAGS] & BROKEN) !== 0;
}
