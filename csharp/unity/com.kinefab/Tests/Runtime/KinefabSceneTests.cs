using System.Collections;
using System.Collections.Generic;
using System.Text;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace KinefabUnity.Tests
{
    /// <summary>Mechanisms in Unity's own physics.</summary>
    public sealed class KinefabSceneTests
    {
        private const string Pendulum = @"{""format"": ""kinefab.scene"", ""version"": ""1.0"", ""gameObjects"": [
            {""id"": ""bob"", ""name"": ""Bob"", ""transform"": {""localPosition"": [0.5, 0, 0]}, ""components"": [
                {""type"": ""Rigidbody"", ""mass"": 2, ""inertiaTensor"": [0.1, 0.1, 0.1]},
                {""type"": ""HingeJoint"", ""anchor"": [-0.5, 0, 0], ""axis"": [0, 0, 1], ""autoConfigureConnectedAnchor"": false, ""connectedAnchor"": [0, 0, 0]}]}]}";

        [UnityTest]
        public IEnumerator Instantiate_UnderATurnedParent_SwingsAboutItsOwnAxle()
        {
            var parent = new GameObject("parent");
            parent.transform.position = new Vector3(3, 4, 5);
            var findings = new List<KinefabFinding>();
            GameObject root = KinefabScene.Instantiate(Encoding.UTF8.GetBytes(Pendulum), parent.transform, findings: findings);
            Assert.That(root, Is.Not.Null);
            Transform bob = root.GetComponentInChildren<Rigidbody>().transform;
            for (int i = 0; i < 50; i++)
            {
                yield return new WaitForFixedUpdate();
            }

            Assert.That(Vector3.Distance(bob.TransformPoint(new Vector3(-0.5f, 0, 0)), parent.transform.position), Is.LessThan(1e-3f));
            Object.Destroy(parent);
        }

        [Test]
        public void Instantiate_OfSomethingElse_TellsWhy()
        {
            var findings = new List<KinefabFinding>();
            Assert.That(KinefabScene.Instantiate(Encoding.UTF8.GetBytes("{}"), findings: findings), Is.Null);
            Assert.That(findings, Is.Not.Empty);
        }
    }
}
