#nullable enable
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A picture on its way to the screen. Main thread; to be released, since Unity keeps textures until the
    /// editor ends.</summary>
    internal sealed class PreviewTexture
    {
        public Texture2D? Texture { get; private set; }

        public void Show(PixelCanvas picture)
        {
            if (Texture == null || Texture.width != picture.PixelWidth || Texture.height != picture.PixelHeight)
            {
                Release();
                Texture = new Texture2D(picture.PixelWidth, picture.PixelHeight, TextureFormat.RGBA32, false)
                {
                    name = "HaptoFlow Texture Preview",
                    hideFlags = HideFlags.HideAndDontSave,
                    wrapMode = TextureWrapMode.Clamp,
                };
            }
            Texture.LoadRawTextureData(picture.BottomUp());
            Texture.Apply(false);
        }

        public void Draw(Rect place)
        {
            if (Texture != null)
            {
                GUI.DrawTexture(place, Texture, ScaleMode.StretchToFill);
            }
        }

        public void Release()
        {
            if (Texture != null)
            {
                Object.DestroyImmediate(Texture);
            }
            Texture = null;
        }
    }
}
