using System;
using NUnit.Framework;
using UnityEditor.AssetImporters;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>The stand-ins behave as Unity does where the package depends on it.</summary>
[NonParallelizable]
public sealed class StandInTests
{
    private sealed class Kept : Unity.MonoBehaviour
    {
        public double shown = 1;
        public string word = null!;
        [NonSerialized]
        public int forgotten = 1;
        private int _hidden = 1;
        public int Woken, Enabled;

        public int Hidden { get => _hidden; set => _hidden = value; }

        private void Awake() => Woken++;

        private void OnEnable() => Enabled++;
    }

    [Test]
    public void Context_WithASecondMainObject_Refuses()
    {
        var context = new AssetImportContext("a.kinefab");
        Unity.GameObject a = new("a"), b = new("b");
        context.AddObjectToAsset("a", a);
        context.AddObjectToAsset("b", b);
        context.SetMainObject(a);
        Assert.That(() => context.SetMainObject(b), Throws.InvalidOperationException);
    }

    [Test]
    public void Context_WithAnIdentifierTwice_RefusesUnlessTheClassIsAnother()
    {
        var context = new AssetImportContext("a.kinefab");
        context.AddObjectToAsset("a", new Unity.GameObject("a"));
        context.AddObjectToAsset("a", new Unity.Mesh());
        Assert.That(() => context.AddObjectToAsset("a", new Unity.Mesh()), Throws.InvalidOperationException);
    }

    [Test]
    public void Reload_Behaviour_KeepsWhatIsSerialized()
    {
        Unity.Player.Play(true);
        try
        {
            var kept = new Unity.GameObject("a").AddComponent<Kept>();
            (kept.shown, kept.forgotten, kept.Hidden) = (5, 5, 5);
            Unity.Player.ReloadDomain();
            Assert.That((kept.shown, kept.forgotten, kept.Hidden), Is.EqualTo((5.0, 1, 1)));
            Assert.That((kept.word, kept.Woken, kept.Enabled), Is.EqualTo(("", 1, 2)));
            Unity.Object.DestroyImmediate(kept.gameObject);
            Assert.That(kept == null!, Is.True);
        }
        finally
        {
            Unity.Player.Play(false);
        }
    }

    [Test]
    public void Joint_ThatConfiguresItself_TakesTheAnchorWhereItStandsUnderAScale()
    {
        var parent = new Unity.GameObject("parent");
        parent.transform.localScale = new Unity.Vector3(2, 2, 2);
        parent.transform.rotation = Unity.Quaternion.AngleAxis(90, Unity.Vector3.up);
        Unity.GameObject own = new("own"), other = new("other");
        own.transform.SetParent(parent.transform, false);
        other.transform.SetParent(parent.transform, false);
        other.transform.localPosition = new Unity.Vector3(1, 0, 0);
        own.AddComponent<Unity.Rigidbody>();
        other.AddComponent<Unity.Rigidbody>();
        var joint = own.AddComponent<Unity.HingeJoint>();
        joint.connectedBody = other.GetComponent<Unity.Rigidbody>();
        joint.anchor = new Unity.Vector3(0, 0, 3);
        Assert.That((joint.connectedAnchor - new Unity.Vector3(-1, 0, 3)).magnitude, Is.LessThan(1e-5));
        joint.autoConfigureConnectedAnchor = false;
        joint.connectedAnchor = Unity.Vector3.one;
        Assert.That(joint.connectedAnchor, Is.EqualTo(Unity.Vector3.one));
    }

    [Test]
    public void Rigidbody_WithAMomentOfNothing_Refuses() =>
        Assert.That(() => new Unity.GameObject("a").AddComponent<Unity.Rigidbody>().inertiaTensor = new Unity.Vector3(1, 0, 1), Throws.ArgumentException);

    [Test]
    public void Instantiate_OfATree_TurnsItsReferencesToTheCopies()
    {
        Unity.GameObject root = new("root"), own = new("own"), other = new("other");
        own.transform.SetParent(root.transform, false);
        other.transform.SetParent(root.transform, false);
        own.AddComponent<Unity.Rigidbody>();
        var joint = own.AddComponent<Unity.HingeJoint>();
        joint.autoConfigureConnectedAnchor = false;
        joint.connectedBody = other.AddComponent<Unity.Rigidbody>();
        Unity.GameObject copy = Unity.Object.Instantiate(root);
        Assert.That(copy.GetComponentsInChildren<Unity.HingeJoint>()[0].connectedBody.transform.root, Is.SameAs(copy.transform));
    }
}
