using System;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using Kinefab.Dynamics;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>A small program that uses most of the library, published without what it does not use, and as machine code alone.</summary>
public sealed class TrimmedProgramTests
{
    private const string Code = """
        using System;
        using Kinefab.Dynamics;
        using Kinefab.Kinematics;
        using Kinefab.Advice;
        using Kinefab.Validation;

        ValidScene scene = ValidScene.Load(args[0]);
        Mechanism mechanism = Mechanism.Create(scene);
        MechanismState state = mechanism.NewState();
        DriveResult driven = new PositionSolver(mechanism).Drive(state, "Lever/Crank:1", 60);
        foreach (SolverKind solver in new[] { SolverKind.Unity, SolverKind.Exact })
        {
            World world = World.Create(scene, solver);
            world.Run(1);
            Console.Write($"{world.StateHash():x16} ");
        }

        AdviceReport advice = StabilityAdvice.Of(scene, new AdviceOptions { Seconds = 0.4, MaxTrials = 2 });
        Console.WriteLine($"{driven.Status} mobility {MobilityAnalysis.Of(mechanism).Mobility} findings {advice.Findings.Count} {ValidScene.Load(args[0]).Document.GameObjects[0].Id}");
        """;

    [TestCase("PublishTrimmed")]
    [TestCase("PublishAot")]
    public void Program_Published_RunsAsItDoesOtherwise(string how)
    {
        using var feed = new PackageFeed("Kinefab");
        File.WriteAllText(Path.Combine(feed.Project, "Program.cs"), Code);
        File.WriteAllText(Path.Combine(feed.Project, "small.csproj"), $"""
            <Project Sdk="Microsoft.NET.Sdk">
              <PropertyGroup>
                <OutputType>Exe</OutputType>
                <TargetFramework>net10.0</TargetFramework>
                <RuntimeIdentifier>{RuntimeInformation.RuntimeIdentifier}</RuntimeIdentifier>
                <{how}>true</{how}>
                <SelfContained>true</SelfContained>
                <InvariantGlobalization>true</InvariantGlobalization>
                <TreatWarningsAsErrors>true</TreatWarningsAsErrors>
              </PropertyGroup>
              <ItemGroup><PackageReference Include="Kinefab" Version="0.1.0" /></ItemGroup>
            </Project>
            """);
        feed.Publish(how);
        string lever = Path.Combine(PackageFeed.Source("examples/LeverTests"), "lever.kinefab");
        (int ended, string printed) = PackageFeed.Run(Path.Combine(feed.Project, "out", "small"), feed.Project, lever);
        string hashes = string.Concat(new[] { SolverKind.Unity, SolverKind.Exact }.Select(solver =>
        {
            World world = World.Load(lever, solver);
            world.Run(1);
            return $"{world.StateHash():x16} ";
        }));
        Assert.That((ended, printed.Trim()), Is.EqualTo((0, $"{hashes}Reached mobility 1 findings 1 Lever")));
    }
}
