using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using static Kinefab.Document.ConfigurableJointMotion;

namespace Kinefab.Validation;

/// <summary>Couplings between joint coordinates.</summary>
internal static class CouplingRules
{
    internal static void Check(Coupling coupling, SceneDocument document, in Place at)
    {
        NumberRules.Finite(at, "ratio", coupling.Ratio);
        NumberRules.Finite(at, "offset", coupling.Offset);
        if (Resolve(coupling.A, "a", document, at) is Joint a)
            Moves(coupling.A, a, "a", at);
        if (Resolve(coupling.B, "b", document, at) is Joint b)
            Moves(coupling.B, b, "b", at);
        Itself(coupling, at);
    }

    /// <summary>The joint that a coordinate belongs to, which must have that coordinate.</summary>
    private static Joint? Resolve(JointCoordinate coordinate, string side, SceneDocument document, in Place at)
    {
        if (!NumberRules.Reference(at, side + "/gameObject", coordinate.GameObject, "gameObjects", document.GameObjects.Count))
            return null;
        IReadOnlyList<Component> components = document.GameObjects[coordinate.GameObject].Components;
        if (!NumberRules.Reference(at, side + "/component", coordinate.Component, "components", components.Count))
            return null;
        switch (components[coordinate.Component])
        {
            case HingeJoint hinge when coordinate.Coordinate == Coordinate.Angle:
                return hinge;
            case ConfigurableJoint joint when coordinate.Coordinate != Coordinate.Angle:
                return joint;
            case ArticulationBody when coordinate.Coordinate != Coordinate.Angle && LinkJoint.Of(document, coordinate.GameObject) is Joint link:
                return link;
            case Joint:
                at.Report(side + "/coordinate", DiagnosticCodes.CouplingCoordinateMissing, ("coordinate", Word(coordinate.Coordinate)));
                return null;
            default:
                at.Report(side + "/component", DiagnosticCodes.CouplingNotAJoint, ("component", Invariant.Text(coordinate.Component)));
                return null;
        }
    }

    /// <summary>A locked coordinate holds the other one still.</summary>
    private static void Moves(JointCoordinate coordinate, Joint joint, string side, in Place at)
    {
        if (joint is ConfigurableJoint configurable && Motion(configurable, coordinate.Coordinate) == Locked)
            at.Report(side + "/coordinate", DiagnosticCodes.CouplingCoordinateLocked, ("coordinate", Word(coordinate.Coordinate)));
    }

    private static void Itself(Coupling coupling, in Place at)
    {
        JointCoordinate a = coupling.A, b = coupling.B;
        if (a.GameObject == b.GameObject && a.Component == b.Component && a.Coordinate == b.Coordinate)
            at.Report("b", DiagnosticCodes.CouplingItself);
    }

    private static ConfigurableJointMotion Motion(ConfigurableJoint joint, Coordinate coordinate) => coordinate switch
    {
        Coordinate.X => joint.XMotion,
        Coordinate.Y => joint.YMotion,
        Coordinate.Z => joint.ZMotion,
        Coordinate.AngularX => joint.AngularXMotion,
        Coordinate.AngularY => joint.AngularYMotion,
        _ => joint.AngularZMotion,
    };

    private static string Word(Coordinate coordinate) => CoordinateWords.Table.WordOf(coordinate);
}
