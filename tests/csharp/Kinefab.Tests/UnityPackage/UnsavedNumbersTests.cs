using System.IO;
using System.Linq;
using System.Text.Json.Nodes;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>What Unity saves in no scene and no prefab is there in the game all the same: a copy has it when it comes on.</summary>
public sealed class UnsavedNumbersTests
{
    // A new body, the body that was made, a copy of it, and the copy after it was off and changed by somebody.
    private const string Play = """
        using KinefabUnity;
        using UnityEngine;

        public static class Play
        {
            public static string Run(string path)
            {
                Player.Play(true);
                GameObject root = KinefabScene.Instantiate(path, null, new KinefabSettings(), new System.Collections.Generic.List<KinefabFinding>());
                GameObject copy = Object.Instantiate(root);
                string told = Told(root) + "|" + Told(copy);
                foreach (Rigidbody body in copy.GetComponentsInChildren<Rigidbody>(true))
                {
                    body.solverIterations = 1;
                }

                copy.SetActive(false);
                copy.SetActive(true);
                return told + "|" + Told(copy) + "|" + root.GetComponentsInChildren<KinefabBody>(true).Length;
            }

            private static string Told(GameObject root)
            {
                string told = "";
                foreach (Rigidbody body in root.GetComponentsInChildren<Rigidbody>(true))
                {
                    told += body.GetComponent<KinefabBody>() == null ? "" : System.FormattableString.Invariant($"{body.maxAngularVelocity} {body.solverIterations} {body.solverVelocityIterations} {body.centerOfMass} {body.inertiaTensor} {body.inertiaTensorRotation};");
                }

                foreach (ArticulationBody link in root.GetComponentsInChildren<ArticulationBody>(true))
                {
                    told += System.FormattableString.Invariant($"{link.maxJointVelocity} {link.solverIterations} {link.solverVelocityIterations} {link.centerOfMass} {link.inertiaTensor} {link.inertiaTensorRotation};");
                }

                return told;
            }
        }
        """;

    private static readonly string Arm = Path.Combine(PlayedMechanism.Fixtures, "..", "csharp", "unity", "com.kinefab", "Samples~", "Arm", "Arm.kinefab");

    // Of the lever's bodies the one that stands still needs none.
    [TestCase("2021.3", 3)]
    [TestCase("2022.3", 1)]
    [TestCase("6000.7", 1)]
    public void Copy_OfABody_HasItsNumbers(string editor, int scripts)
    {
        using var scene = new EditedScene();
        scene.Save(json =>
        {
            JsonObject body = json["gameObjects"]!.AsArray().SelectMany(o => o!["components"]?.AsArray() ?? []).OfType<JsonObject>()
                .First(c => c["type"]!.GetValue<string>() == "Rigidbody" && c["isKinematic"] is null);
            (body["maxAngularVelocity"], body["solverIterations"], body["solverVelocityIterations"]) = (11, 13, 4);
            (body["centerOfMass"], body["inertiaTensor"]) = (new JsonArray(0.1, -0.2, 0.3), new JsonArray(2, 3, 4));
        });
        string[] told = UnityEditors.Run(editor, Play, scene.Scene).Split('|');
        Assert.That(told[0], Does.Contain("11 13 4 "));
        Assert.That(told[1..3], Is.All.EqualTo(told[0]));
        Assert.That(told[3], Is.EqualTo($"{scripts}"));
    }

    // 2021.3 saves no inertia, so that every link needs the script there; later ones only where the file says something.
    [TestCase("2021.3", false, 7)]
    [TestCase("6000.7", false, 0)]
    [TestCase("6000.7", true, 1)]
    public void Copy_OfAnArticulation_HasItsNumbers(string editor, bool isStated, int scripts)
    {
        using var scene = new EditedScene(Arm);
        if (isStated)
        {
            scene.Save(json => json["gameObjects"]![3]!["components"]!.AsArray().Single(IsLink)!["maxJointVelocity"] = 3.5);
        }

        string[] told = UnityEditors.Run(editor, Play, scene.Scene).Split('|');
        Assert.That(told[1..3], Is.All.EqualTo(told[0]));
        Assert.That(told[0].Contains("3.5 ", System.StringComparison.Ordinal), Is.EqualTo(isStated));
        Assert.That(told[3], Is.EqualTo($"{scripts}"));
    }

    private static bool IsLink(JsonNode? component) => component!["type"]!.GetValue<string>() == "ArticulationBody";
}
