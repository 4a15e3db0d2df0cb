using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Validation;

namespace Kinefab.Advice.Changes;

/// <summary>Changes that cost time in every step: more iterations, smaller steps.</summary>
internal static class ProjectSettings
{
    private const int MostIterations = 255;

    /// <summary>The number of position iterations times a factor; bodies with numbers of their own get the same.</summary>
    public static Change? SolverIterations(ValidScene scene, int factor)
    {
        Physics physics = scene.Document.Physics;
        int[] own = Enumerable.Range(0, scene.Document.GameObjects.Count).Where(i => scene.Body(i)?.SolverIterations is not null).ToArray();
        int now = Math.Max(physics.SolverIterations, own.Select(i => scene.Body(i)!.SolverIterations!.Value).DefaultIfEmpty(0).Max());
        int then = Math.Min(MostIterations, factor * now);
        if (then == now)
            return null;
        string value = Invariant.Text(then);
        var parts = new List<ChangePart>
        {
            new(
                null,
                $"Project Settings > Physics > Default Solver Iterations {Invariant.Text(physics.SolverIterations)} -> {value} (Physics.defaultSolverIterations)",
                "",
                new SceneEdit("/physics/solverIterations", value)),
        };
        foreach (int i in own)
        {
            int component = scene.Document.GameObjects[i].Components.ToList().FindIndex(c => c is Rigidbody or ArticulationBody);
            parts.Add(new ChangePart(
                i,
                $"{scene.Document.GameObjects[i].Components[component].GetType().Name}.solverIterations -> {value}",
                scene.Document.GameObjects[i].Id,
                new SceneEdit(EditText.Component(i, component) + "/solverIterations", value)));
        }

        return new Change("solverIterations " + value, parts);
    }

    /// <summary>The time step divided by a number.</summary>
    public static Change FixedTimestep(ValidScene scene, int divisor)
    {
        double now = scene.Document.Physics.FixedTimestep;
        string value = Invariant.Text(now / divisor);
        return new Change(
            "fixedTimestep " + value,
            new[]
            {
                new ChangePart(
                    null,
                    $"Project Settings > Time > Fixed Timestep {Invariant.Text(now)} -> {value} (Time.fixedDeltaTime)",
                    "",
                    new SceneEdit("/physics/fixedTimestep", value)),
            });
    }
}
