using System;
using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Mechanisms;

/// <summary>Unity takes no mesh that is not convex on a link, however it is held: there its hull collides, which PhysX makes of the mesh.</summary>
internal static class LinkColliders
{
    // Of a mesh's size: what a point may lie off a plane and be in it.
    private const double Flat = 1e-6;

    /// <summary>The components of an object below a link; each in its place.</summary>
    internal static IReadOnlyList<Component> Convex(ValidScene scene, int gameObject, List<Diagnostic> findings)
    {
        IReadOnlyList<Component> components = scene.Document.GameObjects[gameObject].Components;
        Component[]? convex = null;
        for (int c = 0; c < components.Count; c++)
        {
            if (components[c] is not MeshCollider { Convex: false } collider)
                continue;
            convex ??= new List<Component>(components).ToArray();
            bool isFlat = IsFlat(scene.Mesh(collider.Mesh).Positions);
            convex[c] = isFlat ? Box(collider, scene.Document.Meshes[collider.Mesh].Bounds) : collider with { Convex = true };
            string code = isFlat ? DiagnosticCodes.ColliderFlatAsBox : DiagnosticCodes.ColliderMeshAsHull;
            findings.Add(Diagnostic.Of(code, new JointPlace(gameObject, c).Pointer, ("collider", $"collider {collider.Id ?? scene.Document.GameObjects[gameObject].Id}")));
        }

        return convex ?? components;
    }

    private static BoxCollider Box(MeshCollider from, Bounds about) => new()
    {
        IsTrigger = from.IsTrigger,
        Enabled = from.Enabled,
        Material = from.Material,
        Group = from.Group,
        Id = from.Id,
        Center = about.Center,
        Size = 2 * about.Extents,
        ExtrasJson = from.ExtrasJson,
    };

    // Farthest from one, from the line of two, from the plane of three.
    private static bool IsFlat(ReadOnlySpan<float> positions)
    {
        if (positions.Length < 12)
            return true;
        Vector3d first = At(positions, 0), along = Farthest(positions, first, Vector3d.Zero, Vector3d.Zero);
        double size = along.Length;
        Vector3d x = along.Normalized(), across = Farthest(positions, first, x, Vector3d.Zero);
        return Farthest(positions, first, x, across.Normalized()).Length <= Flat * size;
    }

    private static Vector3d Farthest(ReadOnlySpan<float> positions, Vector3d from, Vector3d x, Vector3d y)
    {
        Vector3d farthest = Vector3d.Zero;
        for (int i = 0; i < positions.Length; i += 3)
        {
            Vector3d to = At(positions, i) - from;
            to -= Vector3d.Dot(to, x) * x;
            to -= Vector3d.Dot(to, y) * y;
            farthest = to.LengthSquared > farthest.LengthSquared ? to : farthest;
        }

        return farthest;
    }

    private static Vector3d At(ReadOnlySpan<float> positions, int i) => new(positions[i], positions[i + 1], positions[i + 2]);
}
