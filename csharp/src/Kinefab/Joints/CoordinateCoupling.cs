using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// A linear relation between joint coordinates, for gears, belts, racks, screws and what follows several joints. PhysX 4.1 and Unity
/// have no such joint: here it is one rigid row over the bodies of all its joints, so that reactions act where they should.
/// C = sum of Factor_i q_i - Offset; Cdot = sum of Factor_i row_i.
/// </summary>
internal sealed class CoordinateCoupling
{
    /// <summary>Those that are followed, then the one that follows.</summary>
    public readonly CoordinateAxisMap[] Coordinates;

    /// <summary>For each coordinate: 1 for the one that follows, of the others less its unit for each unit of theirs, radians and metres.</summary>
    public readonly double[] Factors;

    /// <summary>Unit of the coordinate that follows.</summary>
    public double Offset;

    /// <summary>Coordinates at the last finished step; angles are unwrapped against them.</summary>
    public readonly double[] Last;

    /// <summary>The rows of the coordinates where they were evaluated last.</summary>
    public readonly ConstraintRow[] Rows;

    /// <summary>Indices of the coordinates that may be an <see cref="AngleAmongOthers"/>: angles of joints that turn about other axes too.</summary>
    public readonly int[] AnglesAmongOthers;

    /// <summary>Index of the one that is, where the rows were built last; any before.</summary>
    public int Among;

    /// <summary>That one where the rows were evaluated last.</summary>
    public AngleAmongOthers Angle;

    public CoordinateCoupling(CoordinateAxisMap driven, IReadOnlyList<(CoordinateAxisMap Coordinate, double Ratio)> terms, double offset)
    {
        Coordinates = new CoordinateAxisMap[terms.Count + 1];
        Factors = new double[Coordinates.Length];
        for (int i = 0; i < terms.Count; i++)
        {
            Coordinates[i] = terms[i].Coordinate;
            Factors[i] = -terms[i].Ratio;
        }

        Coordinates[^1] = driven;
        Factors[^1] = 1;
        Offset = offset;
        Last = new double[Coordinates.Length];
        Rows = new ConstraintRow[Coordinates.Length];
        AnglesAmongOthers = Enumerable.Range(0, Coordinates.Length).Where(i => IsAmongOthers(Coordinates[i])).ToArray();
        foreach (int i in AnglesAmongOthers)
        {
            Among = i;
            ((D6Joint)Coordinates[i].Joint).Couple(Coordinates[i].Axis - CoordinateAxis.AngularX, TryFollowOthers);
        }
    }

    /// <summary>Whether none of its joints has broken.</summary>
    public bool IsWhole
    {
        get
        {
            foreach (CoordinateAxisMap coordinate in Coordinates)
            {
                if (coordinate.Joint.IsBroken)
                {
                    return false;
                }
            }

            return true;
        }
    }

    /// <summary>Counts a coordinate of a joint from elsewhere: what it was by so much is it by so much less.</summary>
    public void Recount(JointModel joint, CoordinateAxis axis, double less)
    {
        for (int i = 0; i < Coordinates.Length; i++)
        {
            if (Coordinates[i].Joint == joint && Coordinates[i].Axis == axis)
            {
                Offset -= Factors[i] * Coordinates[i].Sign * less;
            }
        }
    }

    /// <summary>Whether it is an angle of a joint that turns about other axes too.</summary>
    public static bool IsAmongOthers(CoordinateAxisMap coordinate) =>
        coordinate.IsAngle && coordinate.Joint is D6Joint joint
        && (joint.Twist != AxisMotion.Locked ? 1 : 0) + (joint.Swing1 != AxisMotion.Locked ? 1 : 0) + (joint.Swing2 != AxisMotion.Locked ? 1 : 0) > 1;

    /// <inheritdoc cref="D6Joint.AngleByOthers"/>
    private bool TryFollowOthers(int axis, in JointFrames f, out double angle, out Vector3d gradient)
    {
        angle = 0;
        gradient = Vector3d.Zero;
        int own = -1;
        double others = double.PositiveInfinity;
        for (int i = 0; i < Coordinates.Length; i++)
        {
            if (Coordinates[i].Joint != Coordinates[0].Joint || !Coordinates[i].IsAngle)
            {
                return false;
            }

            int other = Coordinates[i].Axis - CoordinateAxis.AngularX;
            own = other == axis ? i : own;
            others = other == axis ? others : Math.Min(others, AngleAmongOthers.SquareOf(f, other));
        }

        if (own < 0 || !(others > AngleAmongOthers.SquareOf(f, axis)))
        {
            return false;
        }

        double left = Offset;
        for (int i = 0; i < Coordinates.Length; i++)
        {
            if (i != own)
            {
                left -= Factors[i] * Coordinates[i].EvaluateAngle(f, Last[i], out ConstraintRow row);
                gradient += row.Angular0 * Factors[i];
            }
        }

        double scale = Coordinates[own].Sign / Factors[own];
        angle = left * scale;
        gradient *= scale;
        return true;
    }

    /// <summary>Factor times coordinate at the poses of its joint's bodies; its row is noted in <see cref="Rows"/>.</summary>
    public double Evaluate(int coordinate, in Pose body0, in Pose body1) =>
        Factors[coordinate] * Coordinates[coordinate].Evaluate(body0, body1, Last[coordinate], out Rows[coordinate]);

    /// <summary>
    /// An angle of a coupling whose joint turns about other axes too, as a ball's twist: 2 atan2(q_i, q_w) of the relative rotation q, which has no
    /// value, and a gradient without end, where the others come to half a turn. The coupling says what it has to be, t; then
    /// C' = 2 f (q_i cos(t / 2) - q_w sin(t / 2)) is 0 where C = f (angle - t) is, and as smooth as q: its row passes there as anywhere else.
    /// Of several angles the one nearest to where it has no value is taken so, since t is smooth in the others.
    /// </summary>
    public struct AngleAmongOthers
    {
        // Radians by which the coupling may be open; C' is 0 a whole turn off, too.
        private const double MostOpen = 1;

        private Quaterniond _built;

        /// <summary>Whether C' stands for C, from the pose at which the rows were built last.</summary>
        public bool IsActive;

        /// <summary>What the other coordinates' rows are multiplied by: cos of half the swing, negative beyond the pole.</summary>
        public double Weight;

        /// <summary>Gradient of C' for the angular velocity of frame 1 against frame 0, in the world.</summary>
        public Vector3d Gradient;

        /// <summary>How near an angle is to where it has no value: the square of c = |(q_i, q_w)|, which is 0 there.</summary>
        public static double SquareOf(in JointFrames f, int axis)
        {
            Quaterniond q = f.Relative.Rotation;
            return q.Vector[axis] * q.Vector[axis] + q.W * q.W;
        }

        /// <summary>C' at a pose; keeps weight and gradient.</summary>
        /// <param name="f">The joint's frames.</param>
        /// <param name="axis">0, 1 or 2.</param>
        /// <param name="angle">Angle, with its whole turns.</param>
        /// <param name="factor">f.</param>
        /// <param name="error">C.</param>
        /// <param name="isBuilt">Whether rows are built at this pose, from which the next poses follow.</param>
        public double Evaluate(in JointFrames f, int axis, double angle, double factor, double error, bool isBuilt)
        {
            if (isBuilt)
            {
                IsActive = Math.Abs(error / factor) < MostOpen;
            }

            return IsActive ? Evaluate(f, axis, angle - error / factor, factor, isBuilt) : error;
        }

        /// <summary>C' of what the coupling says, however far the angle is from it.</summary>
        /// <param name="f">The joint's frames.</param>
        /// <param name="axis">0, 1 or 2.</param>
        /// <param name="target">t.</param>
        /// <param name="factor">f.</param>
        /// <param name="isBuilt">Whether rows are built at this pose, from which the next poses follow.</param>
        public double Evaluate(in JointFrames f, int axis, double target, double factor, bool isBuilt)
        {
            Quaterniond q = f.Relative.Rotation;
            double half = target / 2;
            double cosine = Trigonometry.Cos(half), sine = Trigonometry.Sin(half);
            if (isBuilt)
            {
                _built = q.Vector[axis] * sine + q.W * cosine < 0 ? JointFrames.Negate(q) : q;
            }

            q = JointFrames.Dot(q, _built) < 0 ? JointFrames.Negate(q) : q;
            Vector3d along = axis == 0 ? Vector3d.UnitX : axis == 1 ? Vector3d.UnitY : Vector3d.UnitZ;
            Weight = q.Vector[axis] * sine + q.W * cosine;
            Gradient = f.Q0 * ((along * q.W + Vector3d.Cross(q.Vector, along)) * cosine + q.Vector * sine) * factor;
            return 2 * factor * (q.Vector[axis] * cosine - q.W * sine);
        }
    }
}
