// Builds one articulation in a PhysX 5 scene, runs it and samples it. What a scenario says: ../README.md.
const AXES = { x: ["eTWIST", "eX"], y: ["eSWING1", "eY"], z: ["eSWING2", "eZ"] };
const TYPES = { fixed: "eFIX", prismatic: "ePRISMATIC", revolute: "eREVOLUTE", spherical: "eSPHERICAL" };
const MOTIONS = { locked: "eLOCKED", limited: "eLIMITED", free: "eFREE" };
const MAX_FLOAT = 3.4028234663852886e38;

export function run({ px, top, physics, scale, dispatcher }, scenario, onStep = () => {}) {
  const desc = new px.PxSceneDesc(scale);
  desc.set_gravity(vector(px, scenario.gravity ?? [0, -9.81, 0]));
  desc.set_cpuDispatcher(dispatcher);
  desc.set_filterShader(top.DefaultFilterShader());
  desc.set_solverType(px.PxSolverTypeEnum.ePGS);
  const scene = physics.createScene(desc);
  const articulation = physics.createArticulationReducedCoordinate();
  articulation.setArticulationFlag(px.PxArticulationFlagEnum.eFIX_BASE, scenario.fixed ?? true);
  articulation.setArticulationFlag(px.PxArticulationFlagEnum.eDRIVE_LIMITS_ARE_FORCES, true);
  articulation.setSolverIterationCounts(...(scenario.iterations ?? [6, 1]));
  articulation.setSleepThreshold(0);
  const links = [];
  for (const link of scenario.links) {
    links.push(makeLink(px, articulation, links, link));
  }
  scene.addArticulation(articulation);
  scenario.links.forEach((link, i) => start(px, links[i], link));
  const cache = articulation.createCache();
  articulation.copyInternalStateToCache(cache, new px.PxArticulationCacheFlags(px.PxArticulationCacheFlagEnum.eALL));
  articulation.applyCache(cache, new px.PxArticulationCacheFlags(px.PxArticulationCacheFlagEnum.ePOSITION | px.PxArticulationCacheFlagEnum.eVELOCITY));
  if (scenario.rootVelocity) {
    articulation.setRootLinearVelocity(vector(px, scenario.rootVelocity.linear ?? [0, 0, 0]));
    articulation.setRootAngularVelocity(vector(px, scenario.rootVelocity.angular ?? [0, 0, 0]));
  }
  const bodies = (scenario.bodies ?? []).map((b) => makeBody(px, physics, scene, b, scenario.iterations ?? [6, 1]));
  const actors = { links, bodies };
  const joints = (scenario.joints ?? []).map((j) => makeJoint(px, top, physics, actors, j));
  const start0 = [...links, ...bodies].map(pose);
  const { dt = 0.02, steps = 100, sample = 10 } = scenario;
  const samples = [...links, ...bodies].map(() => []);
  for (let step = 1; step <= steps; step++) {
    for (const { link, force = [0, 0, 0], torque = [0, 0, 0], until = steps } of scenario.forces ?? []) {
      if (step <= until) {
        links[link].addForce(vector(px, force), px.PxForceModeEnum.eFORCE, true);
        links[link].addTorque(vector(px, torque), px.PxForceModeEnum.eFORCE, true);
      }
    }
    scene.simulate(dt);
    scene.fetchResults(true);
    onStep(links);
    if (step % sample === 0) {
      [...links, ...bodies].forEach((b, i) => samples[i].push(...pose(b)));
    }
  }
  joints.forEach((j) => j.release());
  cache.release();
  scene.removeArticulation(articulation);
  articulation.release();
  bodies.forEach((b) => b.release());
  scene.release();
  return { start: start0, bodies: samples };
}

function makeLink(px, articulation, links, l) {
  const link = articulation.createLink(l.parent === undefined ? null : links[l.parent], transform(px, l));
  link.setMass(l.mass ?? 1);
  link.setMassSpaceInertiaTensor(vector(px, l.inertia ?? [1, 1, 1]));
  link.setLinearDamping(l.linearDamping ?? 0);
  link.setAngularDamping(l.angularDamping ?? 0);
  link.setMaxAngularVelocity(1e6);
  link.setMaxLinearVelocity(1e6);
  if (l.useGravity === false) {
    link.setActorFlag(px.PxActorFlagEnum.eDISABLE_GRAVITY, true);
  }
  if (l.compliance !== undefined) {
    link.setCfmScale(l.compliance);
  }
  if (l.parent === undefined) {
    return link;
  }
  const j = l.joint;
  const joint = link.getInboundJoint();
  joint.setJointType(px.PxArticulationJointTypeEnum[TYPES[j.type]]);
  joint.setParentPose(transform(px, j.parentFrame));
  joint.setChildPose(transform(px, j.childFrame));
  joint.setFrictionCoefficient(j.friction ?? 0);
  joint.setMaxJointVelocity(j.maxSpeed ?? 1e6);
  for (const [name, a] of Object.entries(j.axes ?? {})) {
    const axis = axisOf(px, j, name);
    joint.setMotion(axis, px.PxArticulationMotionEnum[MOTIONS[a.motion ?? "free"]]);
    if (a.motion === "limited") {
      joint.setLimitParams(axis, new px.PxArticulationLimit(a.lower, a.upper));
    }
    if (a.stiffness || a.damping) {
      const type = px.PxArticulationDriveTypeEnum[a.acceleration ? "eACCELERATION" : "eFORCE"];
      joint.setDriveParams(axis, new px.PxArticulationDrive(a.stiffness ?? 0, a.damping ?? 0, a.forceLimit ?? MAX_FLOAT, type));
      joint.setDriveTarget(axis, a.target ?? 0);
      joint.setDriveVelocity(axis, a.targetSpeed ?? 0);
    }
  }
  return link;
}

function start(px, link, { joint }) {
  for (const [name, a] of Object.entries(joint?.axes ?? {})) {
    const axis = axisOf(px, joint, name);
    if (a.position) {
      link.getInboundJoint().setJointPosition(axis, a.position);
    }
    if (a.speed) {
      link.getInboundJoint().setJointVelocity(axis, a.speed);
    }
  }
}

const axisOf = (px, j, name) => px.PxArticulationAxisEnum[AXES[name][j.type === "prismatic" ? 1 : 0]];

function makeBody(px, physics, scene, b, iterations) {
  const body = physics.createRigidDynamic(transform(px, b));
  body.setMass(b.mass ?? 1);
  body.setMassSpaceInertiaTensor(vector(px, b.inertia ?? [1, 1, 1]));
  body.setLinearDamping(0);
  body.setAngularDamping(0);
  body.setMaxAngularVelocity(1e6);
  body.setSolverIterationCounts(...iterations);
  body.setSleepThreshold(0);
  scene.addActor(body);
  return body;
}

function makeJoint(px, top, physics, actors, j) {
  const actor = (a) => (a === undefined ? null : a.link !== undefined ? actors.links[a.link] : actors.bodies[a.body]);
  const joint = top.D6JointCreate(physics, actor(j.actor0), transform(px, j.frame0), actor(j.actor1), transform(px, j.frame1));
  const axes = { x: "eX", y: "eY", z: "eZ", twist: "eTWIST", swing1: "eSWING1", swing2: "eSWING2" };
  for (const [axis, motion] of Object.entries(j.motion ?? {})) {
    joint.setMotion(px.PxD6AxisEnum[axes[axis]], px.PxD6MotionEnum[MOTIONS[motion]]);
  }
  return joint;
}

const vector = (px, [x, y, z]) => new px.PxVec3(x, y, z);

const transform = (px, { position = [0, 0, 0], rotation = [0, 0, 0, 1] } = {}) =>
  new px.PxTransform(vector(px, position), new px.PxQuat(rotation[0], rotation[1], rotation[2], rotation[3]));

function pose(body) {
  const { p, q } = body.getGlobalPose();
  return [p.x, p.y, p.z, q.x, q.y, q.z, q.w].map((v) => Number(v.toFixed(7)));
}
