using System;
using System.Collections.Generic;
using Kinefab;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;
using UnityEngine;
using Pose = Kinefab.Numerics.Pose;

namespace KinefabUnity
{
    /// <summary>
    /// Puts the parts where a state has them. Local poses against the parent that the file gives a part, in doubles until the end, so
    /// that the root may stand, turn and be scaled as it likes; a part that somebody has hung elsewhere gets its place in the world.
    /// A part that is destroyed is passed over: the mechanism goes on as if it were there.
    /// </summary>
    internal sealed class PartPlacement
    {
        private readonly MotionState _motion;
        private readonly Transform _root;
        private readonly Transform[] _objects;
        private readonly Part[] _parts;
        private readonly LinkPositions _links;
        private readonly int[] _gameObjects;
        private readonly Pose[] _poses;
        private readonly List<KinefabCoupling> _couplings = new List<KinefabCoupling>();
        private Dictionary<(Component Joint, KinefabCoupling.Coordinate Coordinate), int> _coordinates;
        private int _steppedMoves;
        private bool _hasMoved;
        private float _lastStep;

        public PartPlacement(Transform root, Transform[] parts, MotionState motion)
        {
            _motion = motion;
            _root = root;
            _objects = parts;
            Mechanism mechanism = motion.Mechanism;
            ValidScene scene = mechanism.Scene;
            var found = new List<Part>();
            foreach (int i in mechanism.Bodies)
            {
                // The root stands where its user puts it.
                if (i >= parts.Length || parts[i] == null || parts[i] == root)
                {
                    continue;
                }

                int above = scene.Document.GameObjects[i].Parent ?? -1;
                Vector3d scale = above < 0 ? new Vector3d(1, 1, 1) : scene.WorldTransform(above).Scale;
                found.Add(new Part
                {
                    GameObject = i,
                    Above = above,
                    Unscaled = new Vector3d(1 / scale.X, 1 / scale.Y, 1 / scale.Z),
                    Transform = parts[i],
                    Parent = above < 0 ? root : parts[above],
                    Body = parts[i].GetComponent<Rigidbody>(),
                    Link = parts[i].GetComponent<ArticulationBody>(),
                    Center = scene.Body(i).CenterOfMass,
                    Last = motion.State.Pose(i),
                });
            }

            _parts = found.ToArray();
            _gameObjects = Array.ConvertAll(_parts, part => part.GameObject);
            _poses = new Pose[_parts.Length];
            _links = new LinkPositions(root, parts, motion);
            _steppedMoves = motion.Moves;
        }

        /// <summary>Physics moves some part when it is let go.</summary>
        public bool HasBodies => Array.Exists(_parts, part => part.Body != null || part.Link != null);

        /// <summary>Puts every part in place at once, or only those that physics does not move. Of an articulation that plays only physics moves links.</summary>
        public void Place(bool bodiesToo)
        {
            for (int i = 0; i < _parts.Length; i++)
            {
                ref Part part = ref _parts[i];
                if (part.Transform != null && (!IsInPhysics(part) || (bodiesToo && (part.Link == null || !Application.isPlaying))))
                {
                    Put(part, _motion.State);
                }
            }
        }

        /// <summary>Sends the Rigidbodies to where the state has them by the end of the physics step.</summary>
        public void Step(float dt)
        {
            _hasMoved = _motion.Moves != _steppedMoves;
            _lastStep = dt;
            _steppedMoves = _motion.Moves;
            _links.Step();
            Quaternion turn = _root.rotation;
            for (int i = 0; i < _parts.Length; i++)
            {
                ref Part part = ref _parts[i];
                Pose pose = _motion.State.Pose(part.GameObject);
                part.Before = part.Last;
                part.Last = pose;
                if (part.Transform == null || part.Body == null)
                {
                    continue;
                }

                if (IsInPhysics(part))
                {
                    part.Body.MovePosition(_root.TransformPoint(Numbers.Vector(pose.Position)));
                    part.Body.MoveRotation(turn * Numbers.Rotation(pose.Rotation));
                }
                else
                {
                    Put(part, _motion.State);
                }
            }
        }

        /// <summary>The solver takes the bodies from physics.</summary>
        public void TakeHold()
        {
            _links.TakeHold();
            RestCouplings();
            for (int i = 0; i < _parts.Length; i++)
            {
                ref Part part = ref _parts[i];
                part.Last = _motion.State.Pose(part.GameObject);
                part.Before = part.Last;
                if (part.Body != null && !part.IsHeld)
                {
                    part.WasKinematic = part.Body.isKinematic;
                    part.Body.isKinematic = true;
                    part.IsHeld = true;
                }
            }

            _steppedMoves = _motion.Moves;
            _hasMoved = false;
        }

        /// <summary>Physics takes the bodies over, as fast as the solver last moved them.</summary>
        public void LetGo()
        {
            _links.LetGo();
            foreach (KinefabCoupling coupling in _couplings)
            {
                if (coupling != null)
                {
                    coupling.enabled = true;
                    coupling.TakeTurns(Turned);
                }
            }

            _couplings.Clear();
            for (int i = 0; i < _parts.Length; i++)
            {
                ref Part part = ref _parts[i];
                if (part.Body == null || !part.IsHeld)
                {
                    continue;
                }

                part.IsHeld = false;
                part.Body.isKinematic = part.WasKinematic;
                if (!part.WasKinematic)
                {
                    SetVelocity(part);
                }
            }
        }

        /// <summary>
        /// Makes the joints anew at the exported pose: PhysX counts a joint's angles and limits from where its body stood when the joint was
        /// made, and a scene may have been stored, or its objects switched off and on, with the mechanism moved. That a part that is switched
        /// off and on makes its joints anew is what others saw in the editor, not seen here.
        /// </summary>
        public void RemakeJoints(MechanismState home)
        {
            var off = new List<GameObject>();
            var stood = new (Vector3 Position, Quaternion Rotation)[_parts.Length];
            for (int i = 0; i < _parts.Length; i++)
            {
                Transform at = _parts[i].Transform;
                if (at == null)
                {
                    continue;
                }

                stood[i] = (at.localPosition, at.localRotation);
                if (at.gameObject.activeSelf && at.GetComponent<Joint>() != null)
                {
                    off.Add(at.gameObject);
                }
            }

            if (off.Count == 0)
            {
                return;
            }

            foreach (GameObject part in off)
            {
                part.SetActive(false);
            }

            for (int i = 0; i < _parts.Length; i++)
            {
                if (IsPlaced(_parts[i]))
                {
                    Put(_parts[i], home);
                }
            }

            // A body that a joint hangs on, and that has none of its own, is told of its place only by the next physics step else.
            Physics.SyncTransforms();
            foreach (GameObject part in off)
            {
                part.SetActive(true);
            }

            foreach (KinefabCoupling coupling in _root.GetComponentsInChildren<KinefabCoupling>(true))
            {
                coupling.TakeZero();
                coupling.TakeTurns(Turned);
            }

            for (int i = 0; i < _parts.Length; i++)
            {
                if (IsPlaced(_parts[i]))
                {
                    _parts[i].Transform.localPosition = stood[i].Position;
                    _parts[i].Transform.localRotation = stood[i].Rotation;
                }
            }
        }

        /// <summary>Reads the state off the parts.</summary>
        /// <param name="closes">Whether the joints are closed then, or left as open as physics has them.</param>
        public void ReadBack(bool closes)
        {
            Quaterniond turn = Numbers.Rotation(_root.rotation);
            for (int i = 0; i < _parts.Length; i++)
            {
                Transform at = _parts[i].Transform;
                _poses[i] = at == null
                    ? _motion.State.Pose(_gameObjects[i])
                    : new Pose(Numbers.Vector(_root.InverseTransformPoint(at.position)), (turn.Conjugate() * Numbers.Rotation(at.rotation)).Normalized());
            }

            _motion.Follow(_gameObjects, _poses, closes);
        }

        // Links are where physics has them.
        private static bool IsPlaced(in Part part) => part.Transform != null && part.Link == null;

        // A body that is switched off is in no physics step.
        private static bool IsInPhysics(in Part part) =>
            (part.Body != null || part.Link != null) && part.Transform.gameObject.activeInHierarchy;

        // A coupling that follows would pull at what the solver holds.
        private void RestCouplings()
        {
            foreach (KinefabCoupling coupling in _root.GetComponentsInChildren<KinefabCoupling>(true))
            {
                if (coupling.enabled)
                {
                    coupling.enabled = false;
                    _couplings.Add(coupling);
                }
            }
        }

        // Where the state has a coordinate as its joint or link counts it, over whole turns.
        private double? Turned(Component joint, KinefabCoupling.Coordinate coordinate)
        {
            Mechanism mechanism = _motion.Mechanism;
            if (_coordinates == null)
            {
                _coordinates = new Dictionary<(Component, KinefabCoupling.Coordinate), int>();
                for (int i = 0; i < mechanism.Coordinates.Count; i++)
                {
                    if (JointComponents.Of(mechanism, mechanism.Coordinates[i], _objects) is Component found && found != null)
                    {
                        _coordinates[(found, (KinefabCoupling.Coordinate)mechanism.Coordinates[i].Coordinate)] = i;
                    }
                }
            }

            if (!_coordinates.TryGetValue((joint, coordinate), out int index) || !mechanism.Coordinates[index].IsAngle)
            {
                return null;
            }

            double home = joint is ArticulationBody ? LinkPositions.Home(mechanism, mechanism.Coordinates[index]) * 180 / Math.PI : 0;
            return home + _motion.State.Coordinate(index);
        }

        private void Put(in Part part, MechanismState state)
        {
            Pose pose = state.Pose(part.GameObject);
            if (!ReferenceEquals(part.Transform.parent, part.Parent))
            {
                part.Transform.SetPositionAndRotation(_root.TransformPoint(Numbers.Vector(pose.Position)), _root.rotation * Numbers.Rotation(pose.Rotation));
                return;
            }

            if (part.Above >= 0)
            {
                pose = state.Pose(part.Above).Inverse() * pose;
                pose = new Pose(Vector3d.Scale(part.Unscaled, pose.Position), pose.Rotation);
            }

#if UNITY_2022_2_OR_NEWER
            part.Transform.SetLocalPositionAndRotation(Numbers.Vector(pose.Position), Numbers.Rotation(pose.Rotation));
#else
            part.Transform.localPosition = Numbers.Vector(pose.Position);
            part.Transform.localRotation = Numbers.Rotation(pose.Rotation);
#endif
        }

        private void SetVelocity(in Part part)
        {
            Vector3d linear = Vector3d.Zero, angular = Vector3d.Zero;
            if (_hasMoved && _lastStep > 0)
            {
                linear = (part.Last.Point(part.Center) - part.Before.Point(part.Center)) * (1 / _lastStep);
                Quaterniond turn = part.Last.Rotation * part.Before.Rotation.Conjugate();
                double sense = turn.W < 0 ? -1 : 1;
                double sine = turn.Vector.Length;
                double angle = 2 * Math.Atan2(sine, sense * turn.W);
                angular = sine > 0 ? turn.Vector * (sense * angle / (sine * _lastStep)) : Vector3d.Zero;
            }

            Vector3 speed = _root.TransformVector(Numbers.Vector(linear));
#if UNITY_6000_0_OR_NEWER
            part.Body.linearVelocity = speed;
#else
            part.Body.velocity = speed;
#endif
            part.Body.angularVelocity = _root.rotation * Numbers.Vector(angular);
        }

        private struct Part
        {
            public int GameObject;
            public int Above;
            public Vector3d Unscaled;
            public Transform Transform;
            public Transform Parent;
            public Rigidbody Body;
            public ArticulationBody Link;
            public Vector3d Center;
            public Pose Last;
            public Pose Before;
            public bool IsHeld;
            public bool WasKinematic;
        }
    }
}
