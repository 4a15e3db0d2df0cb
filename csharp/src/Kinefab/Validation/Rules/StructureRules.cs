using System;
using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>How GameObjects and components hang together.</summary>
internal static class StructureRules
{
    /// <summary>An id names one GameObject, so that a re-import finds it again.</summary>
    internal static void Id(GameObject gameObject, int index, Dictionary<string, int> first, in Place at)
    {
        string id = gameObject.Id;
        if (id.Length == 0)
            at.Report("id", DiagnosticCodes.IdEmpty);
        else if (!first.TryAdd(id, index))
            at.Report("id", DiagnosticCodes.IdDuplicate, ("id", id), ("first", Invariant.Text(first[id])));
    }

    /// <summary>The ground is one, and a site is a frame and nothing else.</summary>
    internal static void Role(GameObject gameObject, int index, ref int ground, in Place at)
    {
        if (gameObject.Role == GameObjectRole.Site && (gameObject.ComponentSpan.Length > 0 || gameObject.Parent is null))
            at.Report("role", DiagnosticCodes.SiteNotAFrame);
        if (gameObject.Role != GameObjectRole.Ground)
            return;
        if (ground >= 0)
            at.Report("role", DiagnosticCodes.GroundTwice, ("first", Invariant.Text(ground)));
        else
            ground = index;
    }

    /// <summary>Two GameObjects that are there.</summary>
    internal static void Ignored(IgnoredCollision pair, int objects, in Place at)
    {
        bool isThere = NumberRules.Reference(at, "a", pair.A, "gameObjects", objects);
        if (NumberRules.Reference(at, "b", pair.B, "gameObjects", objects) && isThere && pair.A == pair.B)
            at.Report("b", DiagnosticCodes.IgnoredCollisionItself);
    }

    /// <summary>A parent stands before its children, so there are no cycles.</summary>
    internal static void Parent(GameObject gameObject, int index, in Place at)
    {
        if (gameObject.Parent is int parent && (parent < 0 || parent >= index))
            at.Report("parent", DiagnosticCodes.ParentNotEarlier, ("parent", Invariant.Text(parent)), ("index", Invariant.Text(index)));
    }

    /// <summary>Unity allows one Rigidbody, ArticulationBody, MeshFilter and MeshRenderer on a GameObject.</summary>
    internal static void SingleComponents(ReadOnlySpan<Component> components, int gameObject, Findings findings)
    {
        bool body = false, link = false, filter = false, renderer = false;
        for (int i = 0; i < components.Length; i++)
        {
            switch (components[i])
            {
                case Rigidbody:
                    Once(ref body, nameof(Rigidbody), DiagnosticCodes.RigidbodyDuplicate, new Place(findings, "gameObjects", gameObject, i));
                    break;
                case ArticulationBody:
                    Once(ref link, nameof(ArticulationBody), DiagnosticCodes.ComponentDuplicate, new Place(findings, "gameObjects", gameObject, i));
                    break;
                case MeshFilter:
                    Once(ref filter, nameof(MeshFilter), DiagnosticCodes.ComponentDuplicate, new Place(findings, "gameObjects", gameObject, i));
                    break;
                case MeshRenderer:
                    Once(ref renderer, nameof(MeshRenderer), DiagnosticCodes.ComponentDuplicate, new Place(findings, "gameObjects", gameObject, i));
                    break;
            }
        }
    }

    private static void Once(ref bool seen, string type, string code, in Place at)
    {
        if (seen)
            at.Report("", code, ("type", type));
        seen = true;
    }
}
