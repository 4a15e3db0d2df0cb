using System;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;

namespace Kinefab.Tests.Kinematics;

/// <summary>Planar four-bar with ground pins at 0 and (d, 0), all axes along z; its open branch in closed form.</summary>
internal sealed class FourBar
{
    private readonly double _a, _b, _c, _d;

    public FourBar(double a, double b, double c, double d, double crankDegrees, double min = 0, double max = 0)
    {
        (_a, _b, _c, _d) = (a, b, c, d);
        CrankStart = crankDegrees;
        (Vector3d pin, Vector3d far) = Pins(crankDegrees);
        Crank = Scene.Body("crank", pin * 0.5);
        Coupler = Scene.Body("coupler", (pin + far) * 0.5);
        Rocker = Scene.Body("rocker", far);
        CrankJoint = Scene.Hinge(Crank, null, Vector3d.Zero, Vector3d.UnitZ, min, max);
        Scene.Hinge(Coupler, Crank, pin, Vector3d.UnitZ);
        RockerJoint = Scene.Hinge(Rocker, null, new Vector3d(d, 0, 0), Vector3d.UnitZ);
        Scene.Hinge(Coupler, Rocker, far, Vector3d.UnitZ, closure: true);
        Mechanism = Scene.Mechanism();
        Drive = CrankJoint.Angle(Mechanism);
    }

    public MechanismScene Scene { get; } = new();

    public int Crank { get; }

    public int Coupler { get; }

    public int Rocker { get; }

    public JointPlace CrankJoint { get; }

    public JointPlace RockerJoint { get; }

    public Mechanism Mechanism { get; }

    public int Drive { get; }

    public double CrankStart { get; }

    /// <summary>Coupler and rocker angles in the world, degrees, by the cosine rule on the triangle over the diagonal.</summary>
    public (double Coupler, double Rocker) Angles(double crankDegrees)
    {
        (Vector3d pin, Vector3d far) = Pins(crankDegrees);
        Vector3d coupler = far - pin;
        Vector3d rocker = far - new Vector3d(_d, 0, 0);
        return (Math.Atan2(coupler.Y, coupler.X) * (180 / Math.PI), Math.Atan2(rocker.Y, rocker.X) * (180 / Math.PI));
    }

    public (double Coupler, double Rocker) AnglesOf(MechanismState state)
    {
        (double coupler, double rocker) = Angles(CrankStart);
        return (Wrap(Scene.TurnAboutZ(state, Coupler) + coupler), Wrap(Scene.TurnAboutZ(state, Rocker) + rocker));
    }

    public static double Wrap(double degrees) => degrees - 360 * Math.Round(degrees / 360);

    private (Vector3d Pin, Vector3d Far) Pins(double crankDegrees)
    {
        double q = crankDegrees * Math.PI / 180;
        var pin = new Vector3d(_a * Math.Cos(q), _a * Math.Sin(q), 0);
        Vector3d diagonal = new Vector3d(_d, 0, 0) - pin;
        double length = diagonal.Length;
        double along = (_b * _b - _c * _c + length * length) / (2 * length);
        double across = Math.Sqrt(_b * _b - along * along);
        Vector3d unit = diagonal * (1 / length);
        return (pin, pin + unit * along + new Vector3d(-unit.Y, unit.X, 0) * across);
    }
}
