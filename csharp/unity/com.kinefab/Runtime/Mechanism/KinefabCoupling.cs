using System;
using System.Collections.Generic;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>
    /// Keeps a joint coordinate at a linear function of others: gears, belts, racks, screws, mimics.
    /// q = sum of ratio * q_term + offset, in degrees and metres, each q the motion of the joint's own body against its
    /// connected one, zero at the pose of the prefab. Works one way: the driven joint follows, its load is not passed on.
    /// A kinematic body is moved to its place; any other is driven there by its joint's spring, or by its link's X drive, which
    /// is the joint's own again while the component is disabled. Links are those of articulations, revolute or prismatic: their one
    /// coordinate is read whatever stands beside them.
    /// </summary>
    public sealed class KinefabCoupling : MonoBehaviour
    {
        public enum Coordinate
        {
            Angle = 0,
            X = 1,
            Y = 2,
            Z = 3,
            AngularX = 4,
            AngularY = 5,
            AngularZ = 6,
        }

        [Serializable]
        public struct Term
        {
            public Joint joint;

            /// <summary>Where the term is a link's coordinate and no joint's.</summary>
            public ArticulationBody articulationBody;
            public Coordinate coordinate;
            public float ratio;

            internal bool IsThere => joint != null || articulationBody != null;
        }

        public Joint driven;

        /// <summary>Where a link is driven and no joint.</summary>
        public ArticulationBody drivenArticulationBody;
        public Coordinate drivenCoordinate;
        public Term[] terms = new Term[0];
        public float offset;

        /// <summary>Of the drive, for each unit of mass or inertia where the editor knows such drives (2022.2).</summary>
        public float stiffness = 10000;

        /// <summary>As stiffness; the default settles without swinging.</summary>
        public float damping = 200;

        private static readonly List<KinefabCoupling> Beside = new List<KinefabCoupling>();

        // Recompiling while the editor plays keeps what can be serialized and loses the rest.
        private Reading _driven;
        private Reading[] _terms;
        private bool _isReady;
        private Vec _halves; // radians, of the turn about each of the joint's axes to which this coupling drives it
        private double _target = double.NaN;
        private Action _release;

        private void Awake()
        {
            Prepare(); // also where the component is disabled: the coordinates are zero where the joints are made
        }

        private void OnEnable()
        {
            if (_isReady && IsThere)
            {
                _release = _release ?? (driven != null ? Release(driven) : Release(drivenArticulationBody));
            }
        }

        private void Start()
        {
            Prepare(); // of a component that a script added, whose fields were empty before
            OnEnable();
        }

        private void OnDisable()
        {
            _halves = default(Vec);
            _target = double.NaN;
            if (_isReady && IsThere)
            {
                _release();
            }
        }

        /// <summary>Counts all coordinates from where the parts stand now: for whoever makes the joints anew there.</summary>
        public void TakeZero()
        {
            _isReady = false;
            Prepare();
        }

        /// <summary>Tells how far its coordinates have turned while it was off, or before it was there: whole turns show in no pose.</summary>
        /// <param name="about">Degrees of a coordinate of a joint or a link, to half a turn; null: it is as it was.</param>
        public void TakeTurns(Func<Component, Coordinate, double?> about)
        {
            if (_isReady)
            {
                _driven.TakeTurns(about);
                Array.ForEach(_terms, t => t.TakeTurns(about));
            }
        }

        private bool IsThere => driven != null || drivenArticulationBody != null;

        private void Prepare()
        {
            if (_isReady || !IsThere || !Array.TrueForAll(terms, t => t.IsThere))
            {
                return;
            }

            _driven = new Reading(driven, drivenArticulationBody, drivenCoordinate);
            _terms = Array.ConvertAll(terms, t => new Reading(t.joint, t.articulationBody, t.coordinate));
            _isReady = true;
        }

        private void FixedUpdate()
        {
            if (!_isReady)
            {
                return;
            }

            if (!IsThere || !Array.TrueForAll(terms, t => t.IsThere))
            {
                OnDisable(); // a joint has broken: what follows it is free
                _isReady = false;
                return;
            }

            Renew();
            double target = offset, beside = 0;
            for (int i = 0; i < terms.Length; i++)
            {
                double value = _terms[i].Value();
                target += terms[i].ratio * value;
                if (driven != null && terms[i].joint == driven && Math.Abs(terms[i].coordinate - drivenCoordinate) == Coordinate.AngularX - Coordinate.X)
                {
                    beside = value; // a screw, whose turn its slide follows
                }
            }

            if (driven == null)
            {
                if (target != _target)
                {
                    drivenArticulationBody.WakeUp();
                    _target = target;
                }

                Drive(drivenArticulationBody, _driven.InPosition(target));
                return;
            }

            var body = driven.gameObject.GetComponent<Rigidbody>();
            if (body.isKinematic)
            {
                _driven.Place(target, beside, out Vector3 position, out Quaternion rotation);
                body.MovePosition(position);
                body.MoveRotation(rotation);
                return;
            }

            if (target != _target)
            {
                body.WakeUp(); // one that sleeps follows no drive
                _target = target;
            }

            if (driven is HingeJoint hinge)
            {
                Drive(hinge, target);
            }
            else if (driven is ConfigurableJoint configurable)
            {
                Drive(configurable, target);
            }
        }

        /// <summary>Reads the terms that are there now, which a script or the inspector may change; those that were there go on counting.</summary>
        private void Renew()
        {
            if (_terms.Length != terms.Length)
            {
                Array.Resize(ref _terms, terms.Length);
            }

            for (int i = 0; i < terms.Length; i++)
            {
                if (_terms[i] == null || !_terms[i].Reads(terms[i].joint, terms[i].articulationBody, terms[i].coordinate))
                {
                    _terms[i] = new Reading(terms[i].joint, terms[i].articulationBody, terms[i].coordinate);
                }
            }
        }

        /// <summary>Gives a joint back the drives that it has now.</summary>
        private static Action Release(Joint joint)
        {
            if (joint is HingeJoint hinge)
            {
                JointSpring spring = hinge.spring;
                bool isSprung = hinge.useSpring, isMotor = hinge.useMotor;
#if UNITY_2022_2_OR_NEWER
                bool accelerates = hinge.useAcceleration;
#endif
                return () =>
                {
                    hinge.spring = spring;
                    hinge.useSpring = isSprung;
                    hinge.useMotor = isMotor;
#if UNITY_2022_2_OR_NEWER
                    hinge.useAcceleration = accelerates;
#endif
                };
            }

            if (!(joint is ConfigurableJoint own))
            {
                return () => { };
            }

            Vector3 position = own.targetPosition;
            Quaternion rotation = own.targetRotation;
            Vector3 speed = own.targetVelocity, turning = own.targetAngularVelocity;
            RotationDriveMode mode = own.rotationDriveMode;
            JointDrive x = own.xDrive, y = own.yDrive, z = own.zDrive, twist = own.angularXDrive, swing = own.angularYZDrive;
            return () =>
            {
                own.targetPosition = position;
                own.targetRotation = rotation;
                own.targetVelocity = speed;
                own.targetAngularVelocity = turning;
                own.rotationDriveMode = mode;
                own.xDrive = x;
                own.yDrive = y;
                own.zDrive = z;
                own.angularXDrive = twist;
                own.angularYZDrive = swing;
            };
        }

        /// <summary>Gives a link back the drive that it has now, within the limits that it has then.</summary>
        private static Action Release(ArticulationBody link)
        {
            ArticulationDrive own = link.xDrive;
            return () =>
            {
                ArticulationDrive drive = link.xDrive;
                own.lowerLimit = drive.lowerLimit;
                own.upperLimit = drive.upperLimit;
                link.xDrive = own;
            };
        }

        private void Drive(ArticulationBody link, double target)
        {
            ArticulationDrive drive = link.xDrive;
#if UNITY_2022_2_OR_NEWER
            bool isOurs = drive.driveType == ArticulationDriveType.Acceleration;
#else
            bool isOurs = true;
#endif
            if (!isOurs || drive.stiffness != stiffness || drive.damping != damping || drive.targetVelocity != 0 || drive.forceLimit != float.MaxValue)
            {
                drive.stiffness = stiffness;
                drive.damping = damping;
                drive.targetVelocity = 0;
                drive.forceLimit = float.MaxValue;
#if UNITY_2022_2_OR_NEWER
                drive.driveType = ArticulationDriveType.Acceleration;
#endif
                link.xDrive = drive;
            }

#if UNITY_2022_2_OR_NEWER
            link.SetDriveTarget(ArticulationDriveAxis.X, (float)target);
#else
            drive.target = (float)target;
            link.xDrive = drive;
#endif
        }

        private void Drive(HingeJoint hinge, double target)
        {
            // A hinge's angle is known within one turn.
            double wrapped = hinge.useLimits ? target : target - 360 * Math.Round(target / 360);
            hinge.useMotor = false;
            hinge.spring = new JointSpring { spring = stiffness, damper = damping, targetPosition = (float)wrapped };
#if UNITY_2022_2_OR_NEWER
            hinge.useAcceleration = true;
#endif
            hinge.useSpring = true;
        }

        private void Drive(ConfigurableJoint joint, double target)
        {
            var drive = new JointDrive { positionSpring = stiffness, positionDamper = damping, maximumForce = float.MaxValue };
#if UNITY_2022_2_OR_NEWER
            drive.useAcceleration = true;
#endif
            // Unity drives the connected body against the own one, unless they are swapped.
            double sense = joint.swapBodies ? 1 : -1;
            int axis = (int)drivenCoordinate - 1;
            if (axis < 3)
            {
                Vector3 position = joint.targetPosition;
                float value = (float)(sense * (target + _driven.Zero)); // Unity counts from where the anchors meet
                joint.targetPosition = new Vector3(axis == 0 ? value : position.x, axis == 1 ? value : position.y, axis == 2 ? value : position.z);
                joint.targetVelocity = Without(joint.targetVelocity, axis);
                if (axis == 0)
                {
                    joint.xDrive = drive;
                }
                else if (axis == 1)
                {
                    joint.yDrive = drive;
                }
                else
                {
                    joint.zDrive = drive;
                }

                return;
            }

            double half = sense * target * Math.PI / 360;
            _halves = new Vec(axis == 3 ? half : 0, axis == 4 ? half : 0, axis == 5 ? half : 0);
            joint.targetRotation = Goal();
            joint.targetAngularVelocity = Without(joint.targetAngularVelocity, axis - 3);
            joint.rotationDriveMode = RotationDriveMode.XYAndZ;
            if (axis == 3)
            {
                joint.angularXDrive = drive;
            }
            else
            {
                joint.angularYZDrive = drive;
            }
        }

        // A damper that still wants the speed of a motor would hold the spring beyond its target.
        private static Vector3 Without(Vector3 speed, int axis)
        {
            return new Vector3(axis == 0 ? 0 : speed.x, axis == 1 ? 0 : speed.y, axis == 2 ? 0 : speed.z);
        }

        /// <summary>Where all couplings of the joint together turn it: each angle is that of the sine about its axis and of w.</summary>
        private Quaternion Goal()
        {
            driven.gameObject.GetComponents(Beside);
            double x = 0, y = 0, z = 0;
            foreach (KinefabCoupling coupling in Beside)
            {
                if (coupling.driven == driven)
                {
                    x += coupling._halves.X;
                    y += coupling._halves.Y;
                    z += coupling._halves.Z;
                }
            }

            double a = Math.Cos(x), b = Math.Cos(y), c = Math.Cos(z);
            Vec sines = new Vec(Math.Sin(x) * b * c, a * Math.Sin(y) * c, a * b * Math.Sin(z));
            double length = Math.Sqrt(sines.Dot(sines) + a * b * c * a * b * c);
            return new Quaternion((float)(sines.X / length), (float)(sines.Y / length), (float)(sines.Z / length), (float)(a * b * c / length));
        }

        /// <summary>One coordinate of a joint or a link: where it stands, and where a joint's body would stand at another value.</summary>
        [Serializable]
        private sealed class Reading
        {
            private Joint _joint;
            private ArticulationBody _link;
            private Coordinate _coordinate;
            private bool _isAngle;
            private Vec _axis;
            private Vec _anchor;
            private Quat _start;
            private Vec _startAt;
            private double _zero;
            private double _last;

            public Reading(Joint joint, ArticulationBody link, Coordinate coordinate)
            {
                _joint = joint;
                _link = link;
                _coordinate = coordinate;
                if (joint == null)
                {
                    _isAngle = link.jointType != ArticulationJointType.PrismaticJoint;
                    return; // a link counts from the pose of the prefab by itself
                }

                _isAngle = coordinate == Coordinate.Angle || coordinate >= Coordinate.AngularX;
                _axis = Axis(joint, coordinate == Coordinate.Angle ? 0 : ((int)coordinate - 1) % 3);
                _anchor = new Vec(joint.anchor);
                Pose(out Quat connected, out Vec connectedAt, out Quat own, out Vec ownAt);
                _start = connected.Inverse() * own;
                _startAt = connected.Inverse() * (ownAt - connectedAt);
                _zero = _isAngle ? 0 : Apart(connected, connectedAt, own, ownAt);
            }

            /// <summary>Metres by which the anchors stood apart at the start: there a slide is at zero, as an angle is.</summary>
            public double Zero => _zero;

            public bool Reads(Joint joint, ArticulationBody link, Coordinate coordinate) => _joint == joint && _link == link && _coordinate == coordinate;

            public void TakeTurns(Func<Component, Coordinate, double?> about)
            {
                _last = about(_joint != null ? (Component)_joint : _link, _coordinate) ?? _last;
            }

            /// <summary>A value as the link's own position has it, which is known within two turns.</summary>
            public double InPosition(double value) => value + Position() - Value();

            /// <summary>Degrees, over whole turns, or metres.</summary>
            public double Value()
            {
                if (_joint == null)
                {
                    double position = Position();
                    return _last = _isAngle ? position + 360 * Math.Round((_last - position) / 360) : position;
                }

                Pose(out Quat connected, out Vec connectedAt, out Quat own, out Vec ownAt);
                if (!_isAngle)
                {
                    return Apart(connected, connectedAt, own, ownAt) - Zero;
                }

                Quat turn = _start.Inverse() * (connected.Inverse() * own);
                double angle = 2 * Math.Atan2(turn.V.Dot(_axis), turn.W) * 180 / Math.PI;
                _last = angle + 360 * Math.Round((_last - angle) / 360);
                return _last;
            }

            /// <summary>The own body's pose at a value, and at one of the motion along a turn's axis or about a slide's; all other
            /// coordinates as they were at the start.</summary>
            public void Place(double value, double beside, out Vector3 position, out Quaternion rotation)
            {
                Pose(out Quat connected, out Vec connectedAt, out _, out _);
                double half = (_isAngle ? value : beside) * Math.PI / 360;
                Quat own = connected * _start;
                Vec anchor = connectedAt + connected * _startAt + own * _anchor + (_isAngle ? beside : value) * (own * _axis);
                own = own * new Quat(Math.Sin(half) * _axis, Math.Cos(half));
                Vec at = anchor - own * _anchor;
                position = new Vector3((float)at.X, (float)at.Y, (float)at.Z);
                rotation = new Quaternion((float)own.V.X, (float)own.V.Y, (float)own.V.Z, (float)own.W);
            }

            private double Position()
            {
                ArticulationReducedSpace at = _link.jointPosition;
                return at.dofCount == 0 ? 0 : at[0] * (_isAngle ? 180 / Math.PI : 1); // none yet while the link is made, nor while it is disabled
            }

            private double Apart(Quat connected, Vec connectedAt, Quat own, Vec ownAt)
            {
                Vec other = connectedAt + connected * new Vec(_joint.connectedAnchor);
                return (ownAt + own * _anchor - other).Dot(Turning(connected, own) * _axis);
            }

            private Quat Turning(Quat connected, Quat own)
            {
                return _joint is ConfigurableJoint joint && joint.swapBodies ? connected * _start : own;
            }

            private void Pose(out Quat connected, out Vec connectedAt, out Quat own, out Vec ownAt)
            {
                own = new Quat(_joint.transform.rotation);
                ownAt = new Vec(_joint.transform.position);
                Rigidbody other = _joint.connectedBody;
                connected = other == null ? new Quat(new Vec(0, 0, 0), 1) : new Quat(other.transform.rotation);
                connectedAt = other == null ? new Vec(0, 0, 0) : new Vec(other.transform.position);
            }

            private static Vec Axis(Joint joint, int index)
            {
                Vec x = new Vec(joint.axis).Unit();
                if (index == 0)
                {
                    return x;
                }

                Vec second = joint is ConfigurableJoint configurable ? new Vec(configurable.secondaryAxis) : new Vec(0, 1, 0);
                Vec z = x.Cross(second).Unit();
                return index == 1 ? z.Cross(x) : z;
            }
        }

        [Serializable]
        private struct Vec
        {
            public double X, Y, Z;

            public Vec(double x, double y, double z)
            {
                X = x;
                Y = y;
                Z = z;
            }

            public Vec(Vector3 v)
                : this(v.x, v.y, v.z)
            {
            }

            public double Dot(Vec b) => X * b.X + Y * b.Y + Z * b.Z;

            public Vec Cross(Vec b) => new Vec(Y * b.Z - Z * b.Y, Z * b.X - X * b.Z, X * b.Y - Y * b.X);

            public Vec Unit() => 1 / Math.Sqrt(Dot(this)) * this;

            public static Vec operator +(Vec a, Vec b) => new Vec(a.X + b.X, a.Y + b.Y, a.Z + b.Z);

            public static Vec operator -(Vec a, Vec b) => new Vec(a.X - b.X, a.Y - b.Y, a.Z - b.Z);

            public static Vec operator *(double s, Vec a) => new Vec(s * a.X, s * a.Y, s * a.Z);
        }

        [Serializable]
        private struct Quat
        {
            public Vec V;
            public double W;

            public Quat(Vec v, double w)
            {
                V = v;
                W = w;
            }

            public Quat(Quaternion q)
                : this(new Vec(q.x, q.y, q.z), q.w)
            {
            }

            public Quat Inverse() => new Quat(-1 * V, W);

            public static Quat operator *(Quat a, Quat b) => new Quat(a.W * b.V + b.W * a.V + a.V.Cross(b.V), a.W * b.W - a.V.Dot(b.V));

            public static Vec operator *(Quat a, Vec b)
            {
                Vec twice = 2 * a.V.Cross(b);
                return b + a.W * twice + a.V.Cross(twice);
            }
        }
    }
}
