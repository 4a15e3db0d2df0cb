using System;
using System.Collections.Generic;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using UnityEngine;
using Doc = Kinefab.Document;
using Pose = Kinefab.Numerics.Pose;

namespace KinefabUnity
{
    /// <summary>
    /// Links of an articulation where a state has them: by their joints' positions, since physics moves a link's Transform and takes no
    /// other. Links that turn about one axis or slide along it; a ball's three angles stay with physics.
    /// </summary>
    internal sealed class LinkPositions
    {
        private readonly Transform _root;
        private readonly MotionState _motion;
        private readonly List<Link> _links = new List<Link>();

        public LinkPositions(Transform root, Transform[] parts, MotionState motion)
        {
            _root = root;
            _motion = motion;
            Mechanism mechanism = motion.Mechanism;
            for (int i = 0; i < mechanism.Coordinates.Count; i++)
            {
                MechanismCoordinate coordinate = mechanism.Coordinates[i];
                int at = coordinate.GameObject;
                if (at < parts.Length && parts[at] != null
                    && mechanism.Scene.Document.GameObjects[at].Components[coordinate.Component] is Doc.ArticulationBody from
                    && from.JointType != Doc.ArticulationJointType.Spherical
                    && mechanism.Scene.Document.GameObjects[at].Parent is int above && mechanism.Scene.BodyOf(above) is int)
                {
                    _links.Add(new Link { Body = parts[at].GetComponent<ArticulationBody>(), Coordinate = i, IsAngle = coordinate.IsAngle, Home = Home(mechanism, coordinate) });
                }
            }
        }

        /// <summary>
        /// A link's coordinate as Unity counts it at the pose in the file, from where its anchors meet: radians or metres of the scene; 0 of a root.
        /// </summary>
        public static double Home(Mechanism mechanism, MechanismCoordinate coordinate)
        {
            Doc.GameObject own = mechanism.Scene.Document.GameObjects[coordinate.GameObject];
            if (!(own.Components[coordinate.Component] is Doc.ArticulationBody link && own.Parent is int above && mechanism.Scene.BodyOf(above) is int parent))
            {
                return 0;
            }

            Pose joint = Frame(mechanism.Scene, parent, link.ParentAnchorPosition, link.ParentAnchorRotation).Inverse()
                * Frame(mechanism.Scene, coordinate.GameObject, link.AnchorPosition, link.AnchorRotation);
            return coordinate.IsAngle
                ? 2 * Math.Atan2(joint.Rotation.Vector[coordinate.Coordinate - Doc.Coordinate.AngularX], joint.Rotation.W)
                : joint.Position.X;
        }

        public void TakeHold()
        {
            foreach (Link link in _links)
            {
                if (link.Body != null && !link.IsHeld)
                {
                    link.IsHeld = true;
                    link.HadGravity = link.Body.useGravity;
                    link.Body.useGravity = false;
                }
            }
        }

        public void Step()
        {
            // Slides stand by metres of the world.
            double scale = _root.lossyScale.x;
            foreach (Link link in _links)
            {
                if (link.Body == null || !link.Body.gameObject.activeInHierarchy)
                {
                    continue;
                }

                double value = _motion.State.Coordinate(link.Coordinate);
                link.Body.jointPosition = new ArticulationReducedSpace((float)(link.IsAngle ? link.Home + value * Math.PI / 180 : scale * (link.Home + value)));
                link.Body.jointVelocity = new ArticulationReducedSpace(0f);
            }
        }

        public void LetGo()
        {
            foreach (Link link in _links)
            {
                if (link.Body != null && link.IsHeld)
                {
                    link.IsHeld = false;
                    link.Body.useGravity = link.HadGravity;
                }
            }
        }

        private static Pose Frame(Kinefab.Validation.ValidScene scene, int gameObject, Vector3d anchor, Quaterniond turn)
        {
            Kinefab.Validation.WorldTransform at = scene.WorldTransform(gameObject);
            return at.Pose * new Pose(Vector3d.Scale(at.Scale, anchor), turn.Normalized());
        }

        private sealed class Link
        {
            public ArticulationBody Body;
            public int Coordinate;
            public bool IsAngle;
            public double Home;
            public bool IsHeld;
            public bool HadGravity;
        }
    }
}
