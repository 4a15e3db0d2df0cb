using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>Meshes, as far as the JSON states them.</summary>
internal static class MeshRules
{
    internal static void Numbers(Mesh mesh, in Place at)
    {
        NumberRules.AtLeast(at, "vertexCount", mesh.VertexCount, 1);
        NumberRules.Finite(at, "bounds/center", mesh.Bounds.Center);
        NumberRules.NotNegative(at, "bounds/extents/0", mesh.Bounds.Extents.X);
        NumberRules.NotNegative(at, "bounds/extents/1", mesh.Bounds.Extents.Y);
        NumberRules.NotNegative(at, "bounds/extents/2", mesh.Bounds.Extents.Z);
    }

    /// <summary>Each submesh holds whole triangles and starts where the one before ends.</summary>
    internal static void Submeshes(Mesh mesh, in Place at)
    {
        long next = 0;
        IReadOnlyList<Submesh> submeshes = mesh.Submeshes;
        for (int i = 0; i < submeshes.Count; i++)
        {
            string field = "submeshes/" + Invariant.Text(i);
            Submesh submesh = submeshes[i];
            if (submesh.IndexCount < 0 || submesh.IndexCount % 3 != 0)
                at.Report(field + "/indexCount", DiagnosticCodes.SubmeshNotTriangles, ("count", Invariant.Text(submesh.IndexCount)));
            else if (submesh.IndexStart != next)
                at.Report(field + "/indexStart", DiagnosticCodes.SubmeshGap, ("start", Invariant.Text(submesh.IndexStart)), ("expected", Invariant.Text(next)));
            next = (long)submesh.IndexStart + submesh.IndexCount;
        }
    }

    /// <summary>Every material exists, and there is one for each submesh: Unity draws the rest not at all.</summary>
    internal static void Renderer(MeshRenderer renderer, Mesh? mesh, int materialCount, in Place at)
    {
        for (int i = 0; i < renderer.Materials.Count; i++)
        {
            if ((uint)renderer.Materials[i] >= (uint)materialCount)
                NumberRules.Reference(at, "materials/" + Invariant.Text(i), renderer.Materials[i], "materials", materialCount);
        }

        if (mesh is not null && renderer.Materials.Count != mesh.Submeshes.Count)
        {
            at.Report(
                "materials",
                DiagnosticCodes.RendererMaterialCount,
                ("materials", Invariant.Text(renderer.Materials.Count)),
                ("submeshes", Invariant.Text(mesh.Submeshes.Count)));
        }
    }
}
