using System.IO;
using System.Linq;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace KinefabUnity.Editing.Tests
{
    /// <summary>The importer in the editor itself: what stand-ins cannot show.</summary>
    public sealed class KinefabImporterTests
    {
        private const string Folder = "Assets/KinefabImporterTests";
        private const string Path = Folder + "/pendulum.kinefab";

        private const string Pendulum = @"{""format"": ""kinefab.scene"", ""version"": ""1.0"", ""gameObjects"": [
            {""id"": ""rig"", ""name"": ""Rig""},
            {""id"": ""frame"", ""name"": ""Frame"", ""parent"": 0, ""components"": [{""type"": ""Rigidbody"", ""isKinematic"": true}]},
            {""id"": ""bob"", ""name"": ""Bob"", ""parent"": 0, ""transform"": {""localPosition"": [0, -0.5, 0]}, ""components"": [
                {""type"": ""Rigidbody"", ""mass"": 2, ""inertiaTensor"": [0.1, 0.2, 0.3]},
                {""type"": ""HingeJoint"", ""connectedBody"": 1, ""anchor"": [0, 0.5, 0], ""axis"": [0, 0, 1], ""autoConfigureConnectedAnchor"": false, ""connectedAnchor"": [0, 0, 0]}]}]}";

        [SetUp]
        public void MakeFolder() => AssetDatabase.CreateFolder("Assets", "KinefabImporterTests");

        [TearDown]
        public void RemoveFolder() => AssetDatabase.DeleteAsset(Folder);

        [Test]
        public void Import_Pendulum_IsAPrefabWithItsJoint()
        {
            GameObject root = Import(Pendulum);
            HingeJoint hinge = root.GetComponentInChildren<HingeJoint>();
            Assert.That(hinge.connectedBody.name, Is.EqualTo("Frame"));
            Assert.That(hinge.connectedAnchor, Is.EqualTo(Vector3.zero));
            Assert.That(hinge.GetComponent<Rigidbody>().inertiaTensor.z, Is.EqualTo(0.3f).Within(1e-6f));
            Assert.That(AssetDatabase.LoadAssetAtPath<KinefabSource>(Path), Is.Not.Null);
        }

        [Test]
        public void Import_OfAFaultyFile_IsNoAsset()
        {
            UnityEngine.TestTools.LogAssert.ignoreFailingMessages = true;
            Assert.That(Import("{\"format\": 1}"), Is.Null);
            Assert.That(KinefabImporterEditor.Of(Path), Is.Not.Empty);
        }

        [Test]
        public void Import_Again_KeepsReferencesToAPart()
        {
            GlobalObjectId before = GlobalObjectId.GetGlobalObjectIdSlow(Import(Pendulum).transform.Find("Bob"));
            GlobalObjectId after = GlobalObjectId.GetGlobalObjectIdSlow(Import(Pendulum.Replace("\"mass\": 2", "\"mass\": 3")).transform.Find("Bob"));
            Assert.That(after, Is.EqualTo(before));
        }

        private static GameObject Import(string text)
        {
            File.WriteAllText(Path, text);
            AssetDatabase.ImportAsset(Path, ImportAssetOptions.ForceUpdate);
            return AssetDatabase.LoadAllAssetsAtPath(Path).OfType<GameObject>().FirstOrDefault(o => o.transform.parent == null);
        }
    }
}
