// What TesterLog needs of UnityEngine, by its names alone: compiled against, never run.
namespace UnityEngine
{
    public class Component
    {
        public string name { get; set; }

        public T GetComponent<T>() => default(T);
    }

    public class MonoBehaviour : Component
    {
    }

    public class GameObject
    {
        public T[] GetComponentsInChildren<T>() => new T[0];
    }

    public struct Vector3
    {
        public float magnitude => 0;
    }

    public class Rigidbody : Component
    {
        public Vector3 angularVelocity { get; set; }
    }

    public class HingeJoint : Component
    {
    }

    public struct ArticulationReducedSpace
    {
        public float this[int i] => 0;
    }

    public class ArticulationBody : Component
    {
        public ArticulationReducedSpace jointPosition { get; set; }

        public ArticulationReducedSpace jointVelocity { get; set; }
    }

    public struct IntegrationInfo
    {
        public string name => "";

        public string description => "";
    }

    public static class Physics
    {
        public static IntegrationInfo GetCurrentIntegrationInfo() => default(IntegrationInfo);
    }

    public static class Application
    {
        public static string unityVersion => "";
    }

    public static class Debug
    {
        public static void Log(object message)
        {
        }
    }

    public static class Mathf
    {
        public const float Rad2Deg = 57.29578f;
    }

    public static class Time
    {
        public static float fixedDeltaTime => 0.02f;
    }
}

namespace UnityEngine.SceneManagement
{
    public struct Scene
    {
        public GameObject[] GetRootGameObjects() => new GameObject[0];
    }

    public static class SceneManager
    {
        public static Scene GetActiveScene() => default(Scene);
    }
}
