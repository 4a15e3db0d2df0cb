// Builds one scenario in a PhysX scene, runs it and samples it. SPEC of a scenario: README.md.
import { ConstraintFlag, transform, vector } from "./physx.mjs";
import { isBroken, setDistanceLimit, setMassScales, setMotor } from "./memory.mjs";

const MAX_FLOAT = 3.4028234663852886e38;
const D6_AXES = { x: "eX", y: "eY", z: "eZ", twist: "eTWIST", swing1: "eSWING1", swing2: "eSWING2" };
const D6_MOTIONS = { locked: "eLOCKED", limited: "eLIMITED", free: "eFREE" };
const D6_DRIVES = { x: "eX", y: "eY", z: "eZ", swing: "eSWING", twist: "eTWIST", slerp: "eSLERP" };
const LOCKS = { linearX: 1, linearY: 2, linearZ: 4, angularX: 8, angularY: 16, angularZ: 32 };

/** Runs a scenario; onStep sees PhysX's bodies after every step. */
export function run({ px, physics, scale }, scenario, onStep = () => {}) {
  const broken = [];
  let step = 0;
  const nothing = () => {};
  const events = px.PxSimulationEventCallback.implement({
    onContactBegin: nothing,
    onContactEnd: nothing,
    onContactPersist: nothing,
    onTriggerBegin: nothing,
    onTriggerEnd: nothing,
    onConstraintBreak: () => broken.push(step),
  });
  const scene = physics.createScene(px.getDefaultSceneDesc(scale, 0, events));
  scene.setGravity(vector(scenario.gravity ?? [0, -9.81, 0]));
  const bodies = scenario.bodies.map((b) => makeBody(px, physics, scene, b));
  let joints = scenario.joints.map((j) => makeJoint(px, physics, bodies, j));

  const { dt = 0.02, steps, sample } = scenario;
  const samples = bodies.map(() => []);
  for (step = 1; step <= steps; step++) {
    scenario.bodies.forEach((b, i) => {
      if (b.kinematic) {
        bodies[i].setKinematicTarget(kinematicTarget(b, step * dt));
      }
    });
    scene.simulate(dt, true);
    scene.fetchResults(true);
    if (broken.at(-1) === step) {
      // Unity destroys a joint that broke.
      const gone = joints.filter((j) => isBroken(px, j));
      joints = joints.filter((j) => !gone.includes(j));
      gone.forEach((j) => j.release());
      if (joints.length + broken.length !== scenario.joints.length) {
        throw new Error("the flags of a broken constraint are not where they were in @c-frame/physx 0.3.0");
      }
    }
    onStep(bodies);
    if (step % sample === 0) {
      bodies.forEach((b, i) => samples[i].push(...pose(b)));
    }
  }
  // The binding cannot release a scene; an empty one costs little.
  joints.forEach((j) => j.release());
  bodies.forEach((b) => scene.removeActor(b, false));
  return { bodies: samples, ...(broken.length ? { broken } : {}) };
}

function makeBody(px, physics, scene, b) {
  const body = physics.createRigidDynamic(transform(b));
  body.setMass(b.mass ?? 1);
  body.setMassSpaceInertiaTensor(vector(b.inertia ?? [1, 1, 1]));
  body.setLinearDamping(b.linearDamping ?? 0);
  body.setAngularDamping(b.angularDamping ?? 0);
  body.setSolverIterationCounts(...(b.iterations ?? [6, 1]));
  body.setSleepThreshold(0);
  if (b.useGravity === false) {
    body.setActorFlag({ value: 2 }, true);
  }
  if (b.locks) {
    const flags = b.locks.reduce((sum, name) => sum | LOCKS[name], 0);
    body.setRigidDynamicLockFlags(new px.PxRigidDynamicLockFlags(flags));
  }
  scene.addActor(body, null);
  if (b.kinematic) {
    body.setRigidBodyFlag({ value: 1 }, true);
  } else {
    body.setLinearVelocity(vector(b.linearVelocity ?? [0, 0, 0]), true);
    body.setAngularVelocity(vector(b.angularVelocity ?? [0, 0, 0]), true);
  }
  return body;
}

// A kinematic body moves with constant linear and angular velocity.
function kinematicTarget(b, t) {
  const [x, y, z] = b.position ?? [0, 0, 0];
  const v = b.linearVelocity ?? [0, 0, 0];
  const w = b.angularVelocity ?? [0, 0, 0];
  const speed = Math.hypot(...w);
  const s = speed > 0 ? Math.sin((speed * t) / 2) / speed : 0;
  const turn = [w[0] * s, w[1] * s, w[2] * s, Math.cos((speed * t) / 2)];
  return transform({ position: [x + v[0] * t, y + v[1] * t, z + v[2] * t], rotation: multiply(turn, b.rotation ?? [0, 0, 0, 1]) });
}

function multiply([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

function makeJoint(px, physics, bodies, j) {
  const type = j.spring ? "d6" : j.type;
  const create = { revolute: px.PxRevoluteJointCreate, d6: px.PxD6JointCreate }[type];
  const actor = (i) => (i === undefined ? null : bodies[i]);
  const joint = create(physics, actor(j.body0), transform(j.frame0), actor(j.body1), transform(j.frame1));
  if (type === "revolute") {
    configureRevolute(px, joint, j);
  } else {
    configureD6(px, joint, j.spring ? springAsD6(j.spring) : j);
  }
  if (j.breakForce !== undefined || j.breakTorque !== undefined) {
    joint.setBreakForce(j.breakForce ?? MAX_FLOAT, j.breakTorque ?? MAX_FLOAT);
  }
  if (j.inverseMassScales) {
    setMassScales(px, joint, j.inverseMassScales);
  }
  joint.setConstraintFlag(ConstraintFlag.driveLimitsAreForces, j.driveLimitsAreForces ?? true);
  joint.setConstraintFlag(ConstraintFlag.disablePreprocessing, j.preprocessing === false);
  joint.setConstraintFlag(ConstraintFlag.enableExtendedLimits, j.extendedLimits ?? false);
  joint.setConstraintFlag(ConstraintFlag.projection, Boolean(j.projection));
  // These setters also mark the joint as changed, which the writes to its memory do not.
  joint.setProjectionLinearTolerance(j.projection?.linear ?? 1e10);
  joint.setProjectionAngularTolerance(j.projection?.angular ?? Math.PI);
  return joint;
}

function configureRevolute(px, joint, j) {
  if (j.limit) {
    joint.setLimit(makeLimit(px, px.PxJointAngularLimitPair, [j.limit.lower, j.limit.upper], j.limit));
    joint.setRevoluteJointFlag({ value: 1 }, true);
  }
  if (j.motor) {
    setMotor(px, joint, j.motor);
  }
}

// A revolute joint with Unity's spring, which PxRevoluteJoint lacks: the same rows but for the spring's error, which is
// twice the sine of half the angle instead of the angle.
function springAsD6({ target, ...drive }) {
  return {
    motion: { twist: "free" },
    drives: { twist: drive },
    drivePose: { rotation: [Math.sin(target / 2), 0, 0, Math.cos(target / 2)] },
  };
}

function configureD6(px, joint, j) {
  for (const [axis, motion] of Object.entries(j.motion ?? {})) {
    joint.setMotion(px.PxD6Axis[D6_AXES[axis]], px.PxD6Motion[D6_MOTIONS[motion]]);
  }
  if (j.linearLimit) {
    setDistanceLimit(px, joint, j.linearLimit);
  }
  if (j.twistLimit) {
    const { lower, upper } = j.twistLimit;
    joint.setTwistLimit(makeLimit(px, px.PxJointAngularLimitPair, [lower, upper], j.twistLimit));
  }
  if (j.swingLimit) {
    const { y, z } = j.swingLimit;
    joint.setSwingLimit(makeLimit(px, px.PxJointLimitCone, [y, z], j.swingLimit));
  }
  for (const [name, d] of Object.entries(j.drives ?? {})) {
    const drive = new px.PxD6JointDrive();
    drive.stiffness = d.stiffness ?? 0;
    drive.damping = d.damping ?? 0;
    drive.forceLimit = d.forceLimit ?? MAX_FLOAT;
    drive.setAccelerationFlag(d.acceleration ?? false);
    joint.setDrive(px.PxD6Drive[D6_DRIVES[name]], drive);
  }
  if (j.drivePose) {
    joint.setDrivePosition(transform(j.drivePose), true);
  }
  if (j.driveVelocity) {
    const { linear = [0, 0, 0], angular = [0, 0, 0] } = j.driveVelocity;
    joint.setDriveVelocity(vector(linear), vector(angular), true);
  }
}

// Every limit states its contact distance or is soft: PhysX's own default would hide in the trace.
// A soft limit is made with its spring, since the binding's property "stiffness" writes the restitution instead.
function makeLimit(px, Limit, range, { restitution = 0, bounceThreshold = 0, stiffness = 0, damping = 0, contactDistance }) {
  if (stiffness || damping) {
    return new Limit(...range, new px.PxSpring(stiffness, damping));
  }
  if (contactDistance === undefined) {
    throw new Error("a hard limit needs a contactDistance");
  }
  return Object.assign(new Limit(...range), { restitution, bounceThreshold, contactDistance });
}

function pose(body) {
  const { translation: p, rotation: q } = body.getGlobalPose();
  return [p.x, p.y, p.z, q.x, q.y, q.z, q.w].map((v) => Number(v.toFixed(7)));
}
