using System;
using System.Collections.Generic;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// The joints' own drives sent to where the freedoms stand. A drive that the joint has keeps its strength; one that it has not is
    /// lent the same that <see cref="KinefabCoupling"/> lends. Given back as they were.
    /// </summary>
    internal sealed class JointTargets
    {
        // For each unit of mass or inertia, where the editor knows such drives (2022.2).
        private const float Stiffness = 10000;
        private const float Damping = 200;

        private readonly List<Driven> _all = new List<Driven>();
        private readonly List<Action> _back = new List<Action>();
        private readonly Transform _root;

        public JointTargets(Mechanism mechanism, Transform root, Transform[] parts, KinefabFreedom[] freedoms)
        {
            _root = root;
            foreach (KinefabFreedom freedom in freedoms)
            {
                MechanismCoordinate coordinate = mechanism.Coordinates[freedom.Coordinate];
                Component found = JointComponents.Of(mechanism, coordinate, parts);
                if (found is ArticulationBody link)
                {
                    Add(freedom.Coordinate, coordinate.Coordinate, link, LinkPositions.Home(mechanism, coordinate));
                }
                else if (found is Joint joint)
                {
                    double zero = coordinate.Coordinate <= Doc.Coordinate.Z && !(joint is HingeJoint)
                        ? mechanism.Scene.AnchorGap(coordinate.GameObject, coordinate.Component)[coordinate.Coordinate - Doc.Coordinate.X]
                        : 0;
                    Add(freedom.Coordinate, coordinate.Coordinate, joint, zero);
                }
            }
        }

        /// <summary>Sends every drive to where the state has its freedom.</summary>
        public void Aim(MotionState motion)
        {
            // Unity's targets are metres of the world.
            double scale = _root.lossyScale.x;
            for (int i = 0; i < _all.Count; i++)
            {
                Driven driven = _all[i];
                MechanismCoordinate coordinate = motion.Mechanism.Coordinates[driven.Index];
                double value = motion.State.Coordinate(driven.Index) * (coordinate.IsAngle ? 1 : scale);
                if (driven.Link != null)
                {
                    Aim(driven.Link, driven.Coordinate, value + driven.Zero * (coordinate.IsAngle ? 180 / Math.PI : scale));
                }
                else if (driven.Joint is HingeJoint hinge)
                {
                    JointSpring spring = hinge.spring;
                    // A hinge's angle is known within one turn.
                    spring.targetPosition = (float)(hinge.useLimits ? value : value - 360 * Math.Round(value / 360));
                    hinge.spring = spring;
                    Wake(hinge);
                }
                else if (driven.Joint is ConfigurableJoint joint)
                {
                    Aim(driven, joint, value, scale);
                    Wake(joint);
                }
            }
        }

        /// <summary>Every drive as it was.</summary>
        public void GiveBack()
        {
            foreach (Action back in _back)
            {
                back();
            }

            _back.Clear();
            _all.Clear();
        }

        private void Add(int index, Doc.Coordinate coordinate, Joint joint, double zero)
        {
            if (joint is HingeJoint hinge)
            {
                JointSpring spring = hinge.spring;
                bool isSprung = hinge.useSpring, isMotor = hinge.useMotor;
                bool isLent = !isSprung || spring.spring <= 0;
#if UNITY_2022_2_OR_NEWER
                bool accelerates = hinge.useAcceleration;
                hinge.useAcceleration = isLent || accelerates;
#endif
                hinge.useMotor = false;
                hinge.spring = isLent ? new JointSpring { spring = Stiffness, damper = Damping } : spring;
                hinge.useSpring = true;
                _back.Add(() =>
                {
                    if (hinge == null)
                    {
                        return;
                    }

                    hinge.spring = spring;
                    hinge.useSpring = isSprung;
                    hinge.useMotor = isMotor;
#if UNITY_2022_2_OR_NEWER
                    hinge.useAcceleration = accelerates;
#endif
                });
            }
            else if (joint is ConfigurableJoint configurable)
            {
                Lend(configurable, coordinate);
            }
            else
            {
                return;
            }

            _all.Add(new Driven { Index = index, Coordinate = coordinate, Joint = joint, Zero = zero });
        }

        private void Lend(ConfigurableJoint joint, Doc.Coordinate coordinate)
        {
            Vector3 position = joint.targetPosition;
            Quaternion rotation = joint.targetRotation;
            Vector3 speed = joint.targetVelocity, turning = joint.targetAngularVelocity;
            RotationDriveMode mode = joint.rotationDriveMode;
            JointDrive x = joint.xDrive, y = joint.yDrive, z = joint.zDrive, twist = joint.angularXDrive, swing = joint.angularYZDrive;

            // A damper that still wants a speed would hold the spring beyond its target.
            if (coordinate > Doc.Coordinate.Z)
            {
                joint.targetAngularVelocity = Without(turning, coordinate - Doc.Coordinate.AngularX);
            }
            else
            {
                joint.targetVelocity = Without(speed, coordinate - Doc.Coordinate.X);
            }

            switch (coordinate)
            {
                case Doc.Coordinate.X:
                    joint.xDrive = Own(x);
                    break;
                case Doc.Coordinate.Y:
                    joint.yDrive = Own(y);
                    break;
                case Doc.Coordinate.Z:
                    joint.zDrive = Own(z);
                    break;
                default:
                    JointDrive slerp = joint.slerpDrive;
                    joint.rotationDriveMode = RotationDriveMode.XYAndZ;
                    if (coordinate == Doc.Coordinate.AngularX)
                    {
                        joint.angularXDrive = Own(mode == RotationDriveMode.Slerp ? slerp : twist);
                    }
                    else
                    {
                        joint.angularYZDrive = Own(mode == RotationDriveMode.Slerp ? slerp : swing);
                    }

                    break;
            }

            _back.Insert(0, () =>
            {
                if (joint == null)
                {
                    return;
                }

                joint.targetPosition = position;
                joint.targetRotation = rotation;
                joint.targetVelocity = speed;
                joint.targetAngularVelocity = turning;
                joint.rotationDriveMode = mode;
                joint.xDrive = x;
                joint.yDrive = y;
                joint.zDrive = z;
                joint.angularXDrive = twist;
                joint.angularYZDrive = swing;
            });
        }

        private void Add(int index, Doc.Coordinate coordinate, ArticulationBody link, double zero)
        {
            ArticulationDrive x = link.xDrive, y = link.yDrive, z = link.zDrive;
            _back.Insert(0, () =>
            {
                if (link != null)
                {
                    link.xDrive = x;
                    link.yDrive = y;
                    link.zDrive = z;
                }
            });
            if (coordinate == Doc.Coordinate.AngularY)
            {
                link.yDrive = Own(y);
            }
            else if (coordinate == Doc.Coordinate.AngularZ)
            {
                link.zDrive = Own(z);
            }
            else
            {
                link.xDrive = Own(x);
            }

            _all.Add(new Driven { Index = index, Coordinate = coordinate, Link = link, Zero = zero });
        }

        private static JointDrive Own(JointDrive drive)
        {
            if (drive.positionSpring > 0 && drive.maximumForce > 0)
            {
                return drive;
            }

            drive.positionSpring = Stiffness;
            drive.positionDamper = Damping;
            drive.maximumForce = float.MaxValue;
#if UNITY_2022_2_OR_NEWER
            drive.useAcceleration = true;
#endif
            return drive;
        }

        private static Vector3 Without(Vector3 speed, int axis) => new Vector3(axis == 0 ? 0 : speed.x, axis == 1 ? 0 : speed.y, axis == 2 ? 0 : speed.z);

        private static ArticulationDrive Own(ArticulationDrive drive)
        {
            drive.targetVelocity = 0;
            if (drive.stiffness > 0 && drive.forceLimit > 0)
            {
                return drive;
            }

            drive.stiffness = Stiffness;
            drive.damping = Damping;
            drive.forceLimit = float.MaxValue;
#if UNITY_2022_2_OR_NEWER
            drive.driveType = ArticulationDriveType.Acceleration;
#endif
            return drive;
        }

        private static void Aim(ArticulationBody link, Doc.Coordinate coordinate, double value)
        {
            if (coordinate == Doc.Coordinate.AngularY)
            {
                ArticulationDrive drive = link.yDrive;
                drive.target = (float)value;
                link.yDrive = drive;
            }
            else if (coordinate == Doc.Coordinate.AngularZ)
            {
                ArticulationDrive drive = link.zDrive;
                drive.target = (float)value;
                link.zDrive = drive;
            }
            else
            {
                ArticulationDrive drive = link.xDrive;
                drive.target = (float)value;
                link.xDrive = drive;
            }

            link.WakeUp();
        }

        // Unity drives the connected body against the own one, unless they are swapped.
        private void Aim(Driven driven, ConfigurableJoint joint, double value, double scale)
        {
            double sense = joint.swapBodies ? 1 : -1;
            if (driven.Coordinate > Doc.Coordinate.Z)
            {
                driven.Half = sense * value * Math.PI / 360;
                joint.targetRotation = Goal(joint);
                return;
            }

            Vector3 position = joint.targetPosition;
            float at = (float)(sense * (value + scale * driven.Zero)); // Unity counts from where the anchors meet
            joint.targetPosition = new Vector3(
                driven.Coordinate == Doc.Coordinate.X ? at : position.x,
                driven.Coordinate == Doc.Coordinate.Y ? at : position.y,
                driven.Coordinate == Doc.Coordinate.Z ? at : position.z);
        }

        // Where all freedoms of the joint together turn it: each angle is that of the sine about its axis and of w.
        private Quaternion Goal(ConfigurableJoint joint)
        {
            double x = 0, y = 0, z = 0;
            foreach (Driven driven in _all)
            {
                if (driven.Joint == joint)
                {
                    x += driven.Coordinate == Doc.Coordinate.AngularX ? driven.Half : 0;
                    y += driven.Coordinate == Doc.Coordinate.AngularY ? driven.Half : 0;
                    z += driven.Coordinate == Doc.Coordinate.AngularZ ? driven.Half : 0;
                }
            }

            double a = Math.Cos(x), b = Math.Cos(y), c = Math.Cos(z);
            var goal = new Quaterniond(Math.Sin(x) * b * c, a * Math.Sin(y) * c, a * b * Math.Sin(z), a * b * c);
            return Numbers.Rotation(goal);
        }

        private static void Wake(Joint joint)
        {
            // One that sleeps follows no drive.
            Rigidbody body = joint.GetComponent<Rigidbody>();
            if (body != null)
            {
                body.WakeUp();
            }
        }

        private sealed class Driven
        {
            public int Index;
            public Doc.Coordinate Coordinate;
            public Joint Joint;
            public ArticulationBody Link;
            public double Zero;
            public double Half;
        }
    }
}
