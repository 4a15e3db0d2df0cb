using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using static Kinefab.Document.ConfigurableJointMotion;

namespace Kinefab.Validation;

/// <summary>Couplings between joint coordinates.</summary>
internal static class CouplingRules
{
    internal static void Check(Coupling coupling, SceneDocument document, HierarchyPlaces places, in Place at)
    {
        NumberRules.Finite(at, "offset", coupling.Offset);
        if (coupling.Terms.Count == 0)
        {
            if (coupling.A is null)
                at.Report("", DiagnosticCodes.FieldMissing, ("field", "a"));
            else
                Follows(coupling.A, "a", document, places, at);
            if (coupling.Ratio is double ratio)
                NumberRules.Finite(at, "ratio", ratio);
            else
                at.Report("", DiagnosticCodes.FieldMissing, ("field", "ratio"));
        }
        else if (coupling.A is not null || coupling.Ratio is not null)
        {
            at.Report(coupling.A is null ? "ratio" : "a", DiagnosticCodes.CouplingTermsBeside);
        }

        Terms(coupling, document, places, at);
        Follows(coupling.B, "b", document, places, at);
        if (coupling.A is JointCoordinate a && Place(a) == Place(coupling.B))
            at.Report("b", DiagnosticCodes.CouplingItself);
    }

    private static void Terms(Coupling coupling, SceneDocument document, HierarchyPlaces places, in Place at)
    {
        var known = new HashSet<(int, int, Coordinate)>();
        for (int i = 0; i < coupling.Terms.Count; i++)
        {
            string term = "terms/" + Invariant.Text(i);
            JointCoordinate coordinate = coupling.Terms[i].Coordinate;
            NumberRules.Finite(at, term + "/ratio", coupling.Terms[i].Ratio);
            Follows(coordinate, term + "/coordinate", document, places, at);
            if (Place(coordinate) == Place(coupling.B))
                at.Report(term + "/coordinate", DiagnosticCodes.CouplingItself);
            else if (!known.Add(Place(coordinate)))
                at.Report(term + "/coordinate", DiagnosticCodes.CouplingTermTwice);
        }
    }

    /// <summary>A coordinate that is there, and moves.</summary>
    private static void Follows(JointCoordinate coordinate, string side, SceneDocument document, HierarchyPlaces places, in Place at)
    {
        if (Resolve(coordinate, side, document, places, at) is Joint joint)
            Moves(coordinate, joint, side, at);
    }

    /// <summary>The joint that a coordinate belongs to, which must have that coordinate.</summary>
    private static Joint? Resolve(JointCoordinate coordinate, string side, SceneDocument document, HierarchyPlaces places, in Place at)
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
            case ArticulationBody when coordinate.Coordinate != Coordinate.Angle && LinkJoint.Of(document, places, coordinate.GameObject) is Joint link:
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

    private static ConfigurableJointMotion Motion(ConfigurableJoint joint, Coordinate coordinate) => coordinate switch
    {
        Coordinate.X => joint.XMotion,
        Coordinate.Y => joint.YMotion,
        Coordinate.Z => joint.ZMotion,
        Coordinate.AngularX => joint.AngularXMotion,
        Coordinate.AngularY => joint.AngularYMotion,
        _ => joint.AngularZMotion,
    };

    private static (int GameObject, int Component, Coordinate Coordinate) Place(JointCoordinate of) => (of.GameObject, of.Component, of.Coordinate);

    private static string Word(Coordinate coordinate) => CoordinateWords.Table.WordOf(coordinate);
}
