namespace UnityShim
{
    /// <summary>What scripts ask of the physics engine.</summary>
    public static class RayCount
    {
        /// <summary>Rays cast at single colliders since the test set it.</summary>
        public static int Rays { get; set; }
    }
}
