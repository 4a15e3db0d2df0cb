using System;
using System.IO;
using System.Linq;
using Microsoft.CodeAnalysis;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>KinefabDragger by the Input System package and below an interface by UGUI: those branches of the sources compiled as a project with them would, and run.</summary>
public sealed class InputSystemTests
{
    // Press on the crank, pull, release; then without a pointer. What there is to see, by a comma each.
    private const string Play = """
        using System.Linq;
        using KinefabUnity;
        using UnityEngine;
        using UnityEngine.InputSystem;

        public static class Play
        {
            public static string Run(string path)
            {
                Player.Play(true);
                GameObject root = KinefabScene.Instantiate(path, null, new KinefabSettings { physics = KinefabPhysics.None }, new System.Collections.Generic.List<KinefabFinding>());
                var mechanism = root.GetComponent<KinefabMechanism>();
                GameObject eye = new GameObject("Eye");
                Bounds crank = mechanism.MovingParts().Single(part => part.name == "Crank").GetComponentsInChildren<MeshRenderer>()[0].bounds;
                eye.transform.position = crank.center - new Vector3(0, 0, 1);
                KinefabDragger dragger = eye.AddComponent<KinefabDragger>();
                dragger.view = eye.AddComponent<Camera>();
                Player.Frame(); // no mouse, no pen, no finger
                string told = Told(dragger, mechanism);
                var pointer = new Pointer();
                typeof(Pointer).GetProperty("current").SetValue(null, pointer);
                (pointer.press.isPressed, pointer.press.wasPressedThisFrame) = (true, true);
                Player.Frame();
                told += Told(dragger, mechanism);
                pointer.press.wasPressedThisFrame = false;
                pointer.position.Value = new Vector2(0.02f, 0);
                Player.Frame();
                told += Told(dragger, mechanism);
                pointer.press.isPressed = false;
                Player.Frame();
                told += Told(dragger, mechanism);
        #if KINEFAB_UGUI
                // A press with a button of an interface before the part, then with what a raycaster sees of the scene itself.
                pointer.position.Value = Vector2.zero;
                UnityEngine.EventSystems.EventSystem events = UnityEngine.EventSystems.EventSystem.current = new GameObject("Events").AddComponent<UnityEngine.EventSystems.EventSystem>();
                UnityEngine.EventSystems.BaseRaycaster[] raycasters =
                    { eye.AddComponent<UnityEngine.UI.GraphicRaycaster>(), eye.AddComponent<UnityEngine.EventSystems.PhysicsRaycaster>() };
                foreach (UnityEngine.EventSystems.BaseRaycaster raycaster in raycasters)
                {
                    mechanism.GoHome();
                    events.Hits.Clear();
                    events.Hits.Add(new UnityEngine.EventSystems.RaycastResult { module = raycaster });
                    (pointer.press.isPressed, pointer.press.wasPressedThisFrame) = (true, true);
                    Player.Frame();
                    told += Told(dragger, mechanism);
                }
        #endif
                return told;
            }

            private static string Told(KinefabDragger dragger, KinefabMechanism mechanism) =>
                (dragger.Part == null ? "-" : dragger.Part.name) + " " + (System.Math.Abs(mechanism.Value("Motor")) > 5 ? "moved" : "still") + ",";
        }
        """;

    [TestCase("2021.3")]
    [TestCase("6000.7")]
    public void Dragger_ByTheInputSystem_PullsWhatThePointerIsOn(string editor)
    {
        string scene = Path.Combine(PlayedMechanism.Fixtures, "..", "csharp", "unity", "com.kinefab", "Samples~", "FourBar", "FourBar.kinefab");
        Assert.That(UnityEditors.Run(editor, Play, scene, "ENABLE_INPUT_SYSTEM", "KINEFAB_INPUT_SYSTEM"), Is.EqualTo("- still,Crank still,Crank moved,- moved,"));
    }

    [Test]
    public void Dragger_PressedOnAnInterface_PullsNothingBehindIt()
    {
        string scene = Path.Combine(PlayedMechanism.Fixtures, "..", "csharp", "unity", "com.kinefab", "Samples~", "FourBar", "FourBar.kinefab");
        string told = UnityEditors.Run("6000.7", Play, scene, "ENABLE_INPUT_SYSTEM", "KINEFAB_INPUT_SYSTEM", "KINEFAB_UGUI");
        Assert.That(told, Is.EqualTo("- still,Crank still,Crank moved,- moved,- still,Crank still,"));
    }

    // With neither way of input nothing is read, and nothing fails.
    [Test]
    public void Sources_WithoutAnyInput_Compile() =>
        Assert.That(UnityEditors.Compile("6000.7", isEditor: true).GetDiagnostics().Where(d => d.Severity == DiagnosticSeverity.Error).Select(d => d.ToString()), Is.Empty);
}
