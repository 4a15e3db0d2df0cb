using System;
using System.Collections.Generic;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;
using Doc = Kinefab.Document;
using Pose = Kinefab.Numerics.Pose;

namespace KinefabUnity.Editing
{
    /// <summary>What a line of a figure belongs to, so that each kind can be left out.</summary>
    internal enum FigureKind
    {
        Joint,
        Closure,
        Coupling,
    }

    /// <summary>A line whose ends go along with one body each.</summary>
    internal readonly struct FigureLine
    {
        public FigureLine(FigureKind kind, int colour, int bodyA, Vector3d a, int bodyB, Vector3d b)
        {
            Kind = kind;
            Colour = colour;
            BodyA = bodyA;
            A = a;
            BodyB = bodyB;
            B = b;
        }

        public FigureKind Kind { get; }

        /// <summary>0xRRGGBB.</summary>
        public int Colour { get; }

        /// <summary>GameObject that end A goes along with; -1: the scene's own frame.</summary>
        public int BodyA { get; }

        /// <summary>In that GameObject's own unscaled frame, metres.</summary>
        public Vector3d A { get; }

        public int BodyB { get; }

        public Vector3d B { get; }
    }

    /// <summary>
    /// Joints as lines, as the HTML page draws them: the axis and the arc of a turn with the fan of its range, the rails of a slide with
    /// their ends, a pointer that goes along with the part, and a line between coupled joints.
    /// </summary>
    internal sealed class JointFigures
    {
        // The page's.
        public const int Hinge = 0xe8590c, Configurable = 0x1c7ed6, Coupled = 0x9c36b5, Pointer = 0xffd43b;
        public static readonly int[] Islands = { 0x4dabf7, 0xffa94d, 0x69db7c, 0xda77f2, 0xffd43b, 0xff8787, 0x38d9a9, 0xa9e34b, 0x748ffc, 0xe599f7 };

        private const int PartsOfAnArc = 40;
        private const double ShareOfTheScene = 0.09;

        private readonly List<FigureLine> _lines = new List<FigureLine>();
        private readonly ValidScene _scene;
        private double _size;

        public JointFigures(Mechanism mechanism)
        {
            _scene = mechanism.Scene;
            var joints = new List<(int GameObject, int Component, Doc.AnchoredJoint Joint)>();
            IReadOnlyList<Doc.GameObject> objects = _scene.Document.GameObjects;
            for (int i = 0; i < objects.Count; i++)
            {
                for (int c = 0; c < objects[i].Components.Count; c++)
                {
                    if (JointAt(i, c) is Doc.AnchoredJoint joint && mechanism.FindCoordinate(i, c, FirstOf(joint)) >= 0)
                    {
                        joints.Add((i, c, joint));
                    }
                }
            }

            _size = ShareOfTheScene * Extent(joints);
            foreach ((int gameObject, int component, Doc.AnchoredJoint joint) in joints)
            {
                Add(gameObject, component, joint);
            }

            foreach (Doc.Coupling coupling in _scene.Document.Couplings)
            {
                foreach (Doc.CouplingTerm term in coupling.Followed)
                {
                    Doc.JointCoordinate from = term.Coordinate;
                    if (JointAt(from.GameObject, from.Component) is Doc.AnchoredJoint a && JointAt(coupling.B.GameObject, coupling.B.Component) is Doc.AnchoredJoint b)
                    {
                        _lines.Add(new FigureLine(
                            FigureKind.Coupling, Coupled,
                            from.GameObject, InBody(from.GameObject, Anchor(from.GameObject, a)),
                            coupling.B.GameObject, InBody(coupling.B.GameObject, Anchor(coupling.B.GameObject, b))));
                    }
                }
            }
        }

        public IReadOnlyList<FigureLine> Lines => _lines;

        /// <summary>A line's ends where a state has them, in the scene's frame.</summary>
        public static void At(MechanismState state, in FigureLine line, out Vector3d a, out Vector3d b)
        {
            a = line.BodyA < 0 ? line.A : state.Pose(line.BodyA).Point(line.A);
            b = line.BodyB < 0 ? line.B : state.Pose(line.BodyB).Point(line.B);
        }

        private Doc.Joint JointAt(int gameObject, int component)
        {
            Doc.Component found = _scene.Document.GameObjects[gameObject].Components[component];
            bool isLink = found is Doc.ArticulationBody && !_scene.IsRootLink(gameObject);
            return found is Doc.Joint || isLink ? _scene.Joint(new Doc.JointCoordinate { GameObject = gameObject, Component = component }) : null;
        }

        // Any that moves: a joint that holds everything has no figure.
        private Doc.Coordinate FirstOf(Doc.AnchoredJoint joint)
        {
            if (joint is Doc.HingeJoint)
            {
                return Doc.Coordinate.Angle;
            }

            var own = (Doc.ConfigurableJoint)joint;
            Doc.ConfigurableJointMotion[] motions = { own.XMotion, own.YMotion, own.ZMotion, own.AngularXMotion, own.AngularYMotion, own.AngularZMotion };
            int first = Array.FindIndex(motions, motion => motion != Doc.ConfigurableJointMotion.Locked);
            return Doc.Coordinate.X + Math.Max(first, 0);
        }

        private double Extent(List<(int GameObject, int Component, Doc.AnchoredJoint Joint)> joints)
        {
            double[] low = { double.MaxValue, double.MaxValue, double.MaxValue }, high = { double.MinValue, double.MinValue, double.MinValue };
            void Take(Vector3d at)
            {
                for (int i = 0; i < 3; i++)
                {
                    low[i] = Math.Min(low[i], at[i]);
                    high[i] = Math.Max(high[i], at[i]);
                }
            }

            foreach ((int gameObject, _, Doc.AnchoredJoint joint) in joints)
            {
                Take(Anchor(gameObject, joint));
                Take(_scene.WorldTransform(gameObject).Pose.Position);
            }

            double extent = joints.Count == 0 ? 0 : new Vector3d(high[0] - low[0], high[1] - low[1], high[2] - low[2]).Length;
            return extent > 0 ? extent : 1;
        }

        private Vector3d Anchor(int gameObject, Doc.AnchoredJoint joint)
        {
            WorldTransform own = _scene.WorldTransform(gameObject);
            return own.Pose.Point(Vector3d.Scale(own.Scale, joint.Anchor));
        }

        private Vector3d InBody(int gameObject, Vector3d world) => gameObject < 0 ? world : _scene.WorldTransform(gameObject).Pose.InversePoint(world);

        private void Add(int gameObject, int component, Doc.AnchoredJoint joint)
        {
            int connected = joint.ConnectedBody ?? -1;
            Vector3d origin = Anchor(gameObject, joint);
            Vector3d[] axes = Axes(gameObject, joint);
            int colour = joint is Doc.HingeJoint ? Hinge : Configurable;
            IReadOnlyList<JointFreedom> freedoms = _scene.Freedoms(gameObject, component);
            foreach (JointFreedom freedom in freedoms)
            {
                bool isTurn = freedom.Coordinate == Doc.Coordinate.Angle || freedom.Coordinate >= Doc.Coordinate.AngularX;
                int i = freedom.Coordinate == Doc.Coordinate.Angle ? 0 : (freedom.Coordinate - Doc.Coordinate.X) % 3;
                bool isFree = double.IsInfinity(freedom.Lower) || double.IsInfinity(freedom.Upper);
                var figure = new Figure(this, joint.Closure ? FigureKind.Closure : FigureKind.Joint, connected, origin, axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3]);
                if (isTurn)
                {
                    Turn(figure, colour, isFree ? 0 : freedom.Lower, isFree ? 360 : freedom.Upper, isFree);
                    if (freedoms.Count < 3)
                    {
                        figure.On(gameObject).Line(Pointer, 0, 0, 0, 0, 1.12 * _size, 0);
                    }
                }
                else
                {
                    Slide(figure, colour, isFree ? -2 * _size : freedom.Lower, isFree ? 2 * _size : freedom.Upper, isFree);
                    figure.On(gameObject).Line(Pointer, 0, -0.25 * _size, 0, 0, 0.25 * _size, 0);
                }
            }
        }

        private void Turn(Figure figure, int colour, double low, double high, bool isFree)
        {
            figure.Line(colour, -1.5 * _size, 0, 0, 1.5 * _size, 0, 0);
            double step = (high - low) * Math.PI / 180 / PartsOfAnArc, start = low * Math.PI / 180;
            for (int k = 0; k < PartsOfAnArc; k++)
            {
                double a = start + k * step, b = a + step;
                figure.Line(colour, 0, _size * Math.Cos(a), _size * Math.Sin(a), 0, _size * Math.Cos(b), _size * Math.Sin(b));
            }

            if (!isFree)
            {
                foreach (double end in new[] { low, high })
                {
                    double a = end * Math.PI / 180;
                    figure.Line(colour, 0, 0, 0, 0, 1.15 * _size * Math.Cos(a), 1.15 * _size * Math.Sin(a));
                }
            }
        }

        private void Slide(Figure figure, int colour, double low, double high, bool isFree)
        {
            foreach (double side in new[] { -0.16, 0.16 })
            {
                figure.Line(colour, low, side * _size, 0, high, side * _size, 0);
            }

            if (!isFree)
            {
                foreach (double end in new[] { low, high })
                {
                    figure.Line(colour, end, -0.4 * _size, 0, end, 0.4 * _size, 0);
                }
            }
        }

        private Vector3d[] Axes(int gameObject, Doc.AnchoredJoint joint)
        {
            Vector3d x = joint.Axis.Normalized();
            Vector3d second = joint is Doc.ConfigurableJoint own ? own.SecondaryAxis : Vector3d.Perpendicular(x);
            Vector3d z = Vector3d.Cross(x, second).Normalized(), y = Vector3d.Cross(z, x);
            bool isInWorld = joint is Doc.ConfigurableJoint { ConfiguredInWorldSpace: true };
            Quaterniond turn = isInWorld ? Quaterniond.Identity : _scene.WorldTransform(gameObject).Pose.Rotation;
            return new[] { turn * x, turn * y, turn * z };
        }

        // Lines in a joint's frame, with x along the freedom, that go along with one body.
        private readonly struct Figure
        {
            private readonly JointFigures _all;
            private readonly FigureKind _kind;
            private readonly int _body;
            private readonly Vector3d _origin, _x, _y, _z;

            public Figure(JointFigures all, FigureKind kind, int body, Vector3d origin, Vector3d x, Vector3d y, Vector3d z)
            {
                _all = all;
                _kind = kind;
                _body = body;
                _origin = origin;
                _x = x;
                _y = y;
                _z = z;
            }

            public Figure On(int body) => new Figure(_all, _kind, body, _origin, _x, _y, _z);

            public void Line(int colour, double ax, double ay, double az, double bx, double by, double bz) =>
                _all._lines.Add(new FigureLine(_kind, colour, _body, At(ax, ay, az), _body, At(bx, by, bz)));

            private Vector3d At(double x, double y, double z) => _all.InBody(_body, _origin + x * _x + y * _y + z * _z);
        }
    }
}
